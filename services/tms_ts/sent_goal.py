"""One goal of one leaf node, from its sending to its end."""

from tms_msg_ts.action import LeafNodeBase

from tms_config.clock import monotonic
from tms_reason import wire
from tms_reason.reason import Reason
from tms_ros.client import Call, Peer
from tms_ts.interrupted_run import Key
from tms_ts.world import GoalState

ACCEPT_LIMIT = 5.0  # s for a subtask to accept or refuse a goal
RECOVERY = 15.0  # s after a loss in which processes may still discover each other

LeafPeer = Peer[LeafNodeBase.Goal, LeafNodeBase.Result, LeafNodeBase.Feedback]
LeafCall = Call[LeafNodeBase.Result, LeafNodeBase.Feedback]


class SentGoal:
    """One goal of one leaf; fields change on the executor thread and in `Machines.advance`."""

    def __init__(self, machine: str, subtask: str, record: str, node: str) -> None:
        self.machine, self.subtask, self.record, self.node = machine, subtask, record, node
        self.name = f"{machine}:{subtask}"  # as `tms ps` lists it
        self.action = f"/{machine}/{subtask}"
        self.state = GoalState.SENDING
        self.reason: Reason | None = None
        self.cancelled = False
        self.begun = monotonic()
        self.call: LeafCall | None = None
        self.peer: LeafPeer | None = None
        self.pid: int | None = None  # pid of the subtask's process when the goal was sent
        self.not_before = 0.0  # monotonic time of the next attempt
        self.waits_since: float | None = None  # monotonic time since which the goal waits for the database
        self.lost_at = 0.0
        self.losses = 0  # times that a process was lost during this goal

    @property
    def key(self) -> Key:
        """What distinguishes this goal from others of the same run."""
        return self.node, self.machine, self.subtask, self.record

    @property
    def feedback(self) -> Reason | None:
        """The subtask's last feedback."""
        return wire.of(getattr(self.call.feedback, "status", "")) if self.call is not None else None

    def unreceived(self) -> bool:
        """Whether the server has not answered within its time."""
        return self.call is not None and not self.call.accepted and monotonic() - self.begun > ACCEPT_LIMIT

    def recovers(self) -> bool:
        """Whether, after a loss, the processes below may not have discovered each other yet."""
        return self.losses > 0 and monotonic() - self.lost_at < RECOVERY

    def cancel(self) -> None:
        """Ask for the cancel; `Machines` watches until the goal has ended."""
        self.cancelled = True
        if self.call is None:
            self.state = GoalState.CANCELLED  # never sent, so no machine moves
        elif self.peer is not None:
            self.peer.cancel(self.call)
