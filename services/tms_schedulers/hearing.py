"""The active runs of all schedulers of a site, as one list."""

from collections.abc import Callable
from functools import partial

from tms_msg_ts.msg import RunStates

from tms_config.config import Site
from tms_ros.node import Ros
from tms_schedulers.names import schedulers


def hear_runs(ros: Ros, site: Site, heard: Callable[[RunStates], None]) -> None:
    """Call `heard` on the executor thread with all active runs and open questions, whenever a scheduler tells its own.

    Those of a scheduler that is away are as it told them last.
    """
    told: dict[str, RunStates] = {}

    def received(scheduler: str, message: RunStates) -> None:
        told[scheduler] = message
        heard(merged(list(told.values())))

    for one in schedulers(site):
        ros.subscribe(RunStates, one.named("runs"), partial(received, one.process), latched=True)


def sample_runs(ros: Ros, site: Site) -> Callable[[], RunStates | None]:
    """A function that returns what all schedulers told last; None if nobody has told anything since its last call."""
    told: dict[str, RunStates] = {}
    new = {one.process: ros.sample(RunStates, one.named("runs")) for one in schedulers(site)}

    def take() -> RunStates | None:
        arrived = {process: messages[-1] for process, take_one in new.items() if (messages := take_one())}
        told.update(arrived)
        return merged(list(told.values())) if arrived else None

    return take


def merged(told: list[RunStates]) -> RunStates:
    """What several schedulers told, as one message."""
    if len(told) == 1:
        return told[0]
    return RunStates(
        runs=[run for one in told for run in one.runs], questions=[asked for one in told for asked in one.questions]
    )
