"""Runs of several schedulers as one list; those of one that has gone silent are not in it for long."""

import threading
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_ts.msg import Question, RunState, RunStates

from tms_schedulers import hearing
from tms_schedulers.hearing import QUIET, hear_runs, sample_runs, wait_for_runs
from tms_schedulers.names import Scheduler

EVERY = (Scheduler("tms:ts", frozenset()), Scheduler("tms:ts_e", frozenset(), "/tms/ts_e"))
SITE: Any = None


class Clock:
    """A clock that a test turns."""

    now = 100.0


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    found = Clock()
    monkeypatch.setattr(hearing, "schedulers", lambda _: EVERY)
    monkeypatch.setattr(hearing, "monotonic", lambda: found.now)
    return found


def told(*runs: str, asks: str = "") -> RunStates:
    questions = [Question(id=asks)] if asks else []
    return RunStates(runs=[RunState(run_id=run) for run in runs], questions=questions)


def names(message: RunStates | None) -> list[str]:
    assert message is not None
    return [run.run_id for run in message.runs]


def test_all_runs_and_questions_are_one_list(clock: Clock) -> None:
    topics: dict[str, Callable[[RunStates], None]] = {}
    heard: list[RunStates] = []
    ros: Any = SimpleNamespace(subscribe=lambda _, topic, hear, latched: topics.update({topic: hear}))
    hear_runs(ros, SITE, heard.append)
    topics["/tms/runs"](told("a", "b"))
    topics["/tms/ts_e/runs"](told("c-e", asks="c-e-1"))
    assert names(heard[0]) == ["a", "b"] and names(heard[1]) == ["a", "b", "c-e"]
    assert [one.id for one in heard[1].questions] == ["c-e-1"]
    topics["/tms/runs"](told())
    assert names(heard[2]) == ["c-e"]
    clock.now += QUIET
    topics["/tms/runs"](told("d"))
    assert names(heard[3]) == ["d"], "the other one is away"


def test_samples_of_all(clock: Clock) -> None:
    waiting: dict[str, list[RunStates]] = {}
    ros: Any = SimpleNamespace(sample=lambda _, topic: lambda: waiting.pop(topic, []))
    take = sample_runs(ros, SITE)
    assert take() is None
    waiting["/tms/ts_e/runs"] = [told("c-e")]
    assert names(take()) == ["c-e"] and take() is None
    waiting["/tms/runs"] = [told("a")]
    assert names(take()) == ["c-e", "a"]
    clock.now += QUIET
    waiting["/tms/runs"] = [told("a")]
    assert names(take()) == ["a"]


def waited(topics: dict[str, list[RunStates]], later: dict[str, RunStates], wanted: str = "") -> RunStates | None:
    """For schedulers of which some have told these messages, and others tell theirs after the call has begun."""

    def subscribe(_: Any, topic: str, hear: Callable[[RunStates], None], latched: bool) -> None:
        for message in topics.get(topic, []):
            hear(message)
        if topic in later:
            threading.Timer(0.05, hear, [later[topic]]).start()

    return wait_for_runs(SimpleNamespace(subscribe=subscribe), SITE, 5.0 if later else 0.0, wanted)  # type: ignore[arg-type]


def test_one_that_tells_twice_does_not_stand_for_another(clock: Clock) -> None:
    found = waited({"/tms/ts_e/runs": [told("c-e"), told()]}, {"/tms/runs": told("a")})
    assert names(found) == ["a"]


def test_while_one_has_told_nothing_nobody_says_that_no_run_is_active(clock: Clock) -> None:
    assert waited({"/tms/ts_e/runs": [told()]}, {}) is None
    assert names(waited({"/tms/ts_e/runs": [told("c-e")]}, {})) == ["c-e"]
    assert names(waited({"/tms/ts_e/runs": [told()], "/tms/runs": [told()]}, {})) == []


def test_the_run_that_is_wanted_is_enough(clock: Clock) -> None:
    assert names(waited({"/tms/ts_e/runs": [told("c-e")]}, {}, "c-e")) == ["c-e"]
