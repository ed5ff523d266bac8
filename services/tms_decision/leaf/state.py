"""The state of the leaf goals of one run."""

from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property

from tms_decision.leaf.effects import Effect, Note
from tms_decision.leaf.events import GoalAsked, Key
from tms_decision.leaf.replay import Replay
from tms_reason.reason import Reason

ACCEPT_LIMIT = 5.0  # s for a subtask to accept or refuse a goal
RECOVERY = 15.0  # s after a loss in which processes may still discover each other


class GoalState(Enum):
    """How far a leaf's goal is."""

    SENDING = "waits to be sent, or to be accepted"
    RUNNING = "is done by its subtask"
    SUCCEEDED = "is done"
    FAILED = "was aborted, rejected or not deliverable"
    CANCELLED = "was halted by the tree, or by the end of the run"

    @cached_property  # each tick asks it of each leaf
    def final(self) -> bool:
        return self in (GoalState.SUCCEEDED, GoalState.FAILED, GoalState.CANCELLED)


@dataclass
class LeafGoal:
    """One goal of one leaf; times are those of the steps."""

    asked: GoalAsked
    begun: float  # when it was asked for, or sent last
    state: GoalState = GoalState.SENDING
    reason: Reason | None = None  # why it waits, or how it has ended
    cancelled: bool = False
    call: int = 0  # its sending that is open at the subtask's server; 0 while there is none
    pid: int | None = None  # of the subtask's process when it was sent
    not_before: float = 0.0  # time of the next attempt
    waits_since: float | None = None  # when it began to wait for the database
    lost_at: float = 0.0
    losses: int = 0  # times that a process was lost during this goal

    @property
    def key(self) -> Key:
        """What distinguishes this goal from others of the same run."""
        return self.asked.key

    @property
    def machine(self) -> str:
        return self.key[1]

    @property
    def name(self) -> str:
        """The subtask, as `tms ps` lists it."""
        return f"{self.key[1]}:{self.key[2]}"

    def unanswered(self, now: float) -> bool:
        """Whether the server has not answered within its time."""
        return self.state is GoalState.SENDING and bool(self.call) and now - self.begun > ACCEPT_LIMIT

    def recovers(self, now: float) -> bool:
        """Whether, after a loss, the processes below may not have discovered each other yet."""
        return self.losses > 0 and now - self.lost_at < RECOVERY


@dataclass
class LeafGoals:
    """Everything that is known of the leaf goals of a run. Only `leaf.step` changes it."""

    run: int  # fencing number
    retries: int  # times that a goal is sent again after a loss
    replay: Replay = field(default_factory=Replay)
    open: list[LeafGoal] = field(default_factory=list)  # goals that have not ended
    stopping: list[str] = field(default_factory=list)  # machines that are being stopped after a loss
    calls: int = 0  # goals sent so far
    failed: dict[Key, float] = field(default_factory=dict)  # time of each goal's last failure
    given_up: set[Reason] = field(default_factory=set)  # processes that supervisord has given up, and that were told
    out: list[Effect] = field(default_factory=list)  # of this step

    def do(self, *effects: Effect) -> None:
        """Want these effects."""
        self.out.extend(effects)

    def note(self, goal: LeafGoal, what: Reason, kind: str = "goal") -> None:
        """Want a line in the journal."""
        self.out.append(Note(kind, goal.key[0], what))

    def taken(self) -> list[Effect]:
        """What is to be done after this step."""
        out, self.out = self.out, []
        return out

    def settled(self) -> bool:
        """Whether every goal has ended and no machine is being stopped."""
        return not self.open and not self.stopping
