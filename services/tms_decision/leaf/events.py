"""What happens to the leaf goals of a run."""

from collections.abc import Mapping
from enum import Flag, auto

from tms_decision.data import Data, Event
from tms_reason.reason import Reason

Key = tuple[str, str, str, str]  # node path, machine, subtask, record


class Failure(Flag):
    """What a failed goal says about the processes below its subtask."""

    LOST = auto()  # one was lost during the goal
    UNREACHED = auto()  # one was not reached, or did not hear of the other ones yet
    NO_STORE = auto()  # the database is away


NO_LOSS = Failure(0)


class Seen(Data):
    """What is seen of the processes that a goal needs."""

    ready: bool = True  # the subtask's server is there
    pid: int | None = None  # of the subtask's process, 0 if it does not run; None: no host agent knows it
    age: float = 0.0  # s for which that process has run at least
    below: Reason | None = None  # what is wrong with the process of gateway or planner
    process: Reason | None = None  # what is wrong with the subtask's process
    given_up: Reason | None = None  # one of the three that supervisord has given up
    machine: Reason | None = None  # why a goal would not move the machine now
    latch: Reason | None = None  # why the machine is latched


class GoalAsked(Event):
    """The tree asks for a goal (`leaf.step.ask`); `number` is new for each."""

    number: int
    key: Key
    seen: Seen
    no_answer: Reason  # if its server does not answer
    away: Reason  # if its server is gone meanwhile


# fmt: off
class CancelAsked(Event): number: int  # the tree halts the leaf, or the run ends
class Looked(Event): seen: Mapping[int, Seen]  # at every tick, for each open goal
class Accepted(Event): call: int
class Ended(Event): call: int; outcome: str; why: Reason; failure: Failure = NO_LOSS  # outcome: of tms_ros.goals
class MachineStopped(Event): machine: str  # the stop after a loss has its receipt
# fmt: on
