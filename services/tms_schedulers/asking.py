"""Asks the scheduler that a run or a question belongs to, of several, without knowing which one that is."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from tms_config.config import Site
from tms_reason.errors import RosError, TmsError
from tms_ros.reasons import NoServer
from tms_schedulers.names import Scheduler, own, schedulers
from tms_schedulers.reasons import OtherScheduler

T = TypeVar("T")


def of_all(site: Site, ask: Callable[[Scheduler], T]) -> tuple[list[T], list[TmsError]]:
    """The answers and the refusals of all schedulers; they are asked at once, since one may be away."""
    answers, refusals = list[T](), list[TmsError]()

    def asked(scheduler: Scheduler) -> None:
        try:
            answers.append(ask(scheduler))
        except TmsError as error:
            refusals.append(error)

    every = schedulers(site)
    with ThreadPoolExecutor(len(every), "schedulers") as pool:
        list(pool.map(asked, every))
    return answers, refusals


def of_any(site: Site, ask: Callable[[Scheduler], T], unknown: str) -> T:
    """The answer of the scheduler that knows what is asked; the others refuse with the code `unknown`.

    Raises:
        TmsError: the refusal of the one that knows it; else that one gave no answer; else nobody knows it.
    """
    answers, refusals = of_all(site, ask)
    if answers:
        return answers[0]
    raise min(refusals, key=lambda error: (error.code == unknown, isinstance(error, RosError)))


def of_first(site: Site, ask: Callable[[Scheduler], T]) -> T:
    """The answer of the first scheduler that gives one; any of them can.

    Raises:
        TmsError: its refusal, or nobody answers.
    """
    *others, last = schedulers(site)
    for one in others:
        try:
            return ask(one)
        except RosError:
            continue
    return ask(last)


def of_its_own(site: Site, start: Callable[[Scheduler], T], unknown: str) -> T:
    """Start a run with the scheduler that it belongs to: each of them knows whose it is.

    One that does not know the run that is to be resumed refuses it with the code `unknown`.

    Raises:
        TmsError: a refusal, or nobody is there.
    """
    every = schedulers(site)
    for one in every:
        try:
            return start(one)
        except TmsError as error:
            why = error.reason
            if isinstance(why, OtherScheduler):
                return start(own(site, why.scheduler))
            if one == every[-1] or not (isinstance(why, NoServer) or error.code == unknown):
                raise
    raise AssertionError
