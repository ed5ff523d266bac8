"""The active runs of all schedulers of a site, as one list."""

import threading
from collections.abc import Callable
from functools import partial

from tms_msg_ts.msg import RunStates

from tms_config.clock import monotonic
from tms_config.config import Site
from tms_ros.node import Ros
from tms_schedulers.names import schedulers

QUIET = 5.0  # s without a message of a scheduler, which tells its runs once a second: its list counts no more


class Lists:
    """What each scheduler told last."""

    def __init__(self) -> None:
        self._told: dict[str, tuple[RunStates, float]] = {}

    def put(self, scheduler: str, message: RunStates) -> None:
        self._told[scheduler] = message, monotonic()

    @property
    def count(self) -> int:
        """How many have told anything."""
        return len(self._told)

    def merged(self) -> RunStates:
        """The lists of all that are there, as one message."""
        now = monotonic()
        lists = [message for message, at in self._told.values() if now - at < QUIET]
        if len(lists) == 1:
            return lists[0]
        return RunStates(
            runs=[run for one in lists for run in one.runs],
            questions=[asked for one in lists for asked in one.questions],
        )


def hear_runs(ros: Ros, site: Site, heard: Callable[[RunStates], None]) -> None:
    """Call `heard` on the executor thread with all active runs and open questions, as soon as they change."""
    lists = Lists()

    def received(scheduler: str, message: RunStates) -> None:
        lists.put(scheduler, message)
        heard(lists.merged())

    _hear(ros, site, received)


def sample_runs(ros: Ros, site: Site) -> Callable[[], RunStates | None]:
    """A function that returns what all schedulers told last; None if nobody has told anything since its last call."""
    lists = Lists()
    new = {one.process: ros.sample(RunStates, one.named("runs")) for one in schedulers(site)}

    def take() -> RunStates | None:
        arrived = {process: messages[-1] for process, take_one in new.items() if (messages := take_one())}
        for process, message in arrived.items():
            lists.put(process, message)
        return lists.merged() if arrived else None

    return take


def wait_for_runs(ros: Ros, site: Site, seconds: float, wanted: str = "") -> RunStates | None:
    """What all schedulers tell, or those that have told anything within `seconds`; `wanted`: a run that is enough.

    None if none of these has a run, and one has told nothing: nobody knows whether that one has any.
    """
    lists, heard, every = Lists(), threading.Condition(), len(schedulers(site))

    def received(scheduler: str, message: RunStates) -> None:
        with heard:
            lists.put(scheduler, message)
            heard.notify_all()

    def enough() -> bool:
        return lists.count == every or any(run.run_id == wanted for run in lists.merged().runs)

    _hear(ros, site, received)
    with heard:
        complete, told = heard.wait_for(enough, seconds), lists.merged()
    return told if complete or told.runs else None


def _hear(ros: Ros, site: Site, received: Callable[[str, RunStates], None]) -> None:
    for one in schedulers(site):
        ros.subscribe(RunStates, one.named("runs"), partial(received, one.process), latched=True)
