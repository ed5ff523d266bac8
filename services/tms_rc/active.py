"""The goal that moves a machine, and what its stop means for the next one."""

import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

from tms_rc.following import Follower
from tms_rc.standstill import NOTHING, Expected
from tms_rc.stopper import Stop
from tms_ros.client import AnyCall, AnyPeer
from tms_ros.server import AnyGoal
from tms_runtime.fence import Owner


class StopKind(Enum):
    """What a stop means for the next motion."""

    LATCH = "latched until re-armed"
    HOLD = "held for its run"
    PLAIN = "the end of a goal or of a run"


@dataclass
class Active:
    """The goal that moves the machine."""

    goal: AnyGoal
    owner: Owner | None
    peer: AnyPeer
    chain: dict[str, Owner]
    start: dict[str, float]  # rad, joints when it began
    sent: float = 0.0  # s, monotonic: when it left for the machine; 0 before
    begun: float = 0.0  # s, monotonic: when the machine's acceptance was received; 0 before
    follower: Follower | None = None  # of a trajectory, once it was accepted
    call: AnyCall | None = None
    stop: Stop | None = None
    changed: threading.Condition = field(default_factory=threading.Condition)

    def expected(self, now: float, dead_times: Mapping[str, float]) -> Expected:
        """The motion that must be seen if it is stopped now.

        The machine may have begun to move as soon as the goal was sent: its answer comes later, or never.
        """
        if not self.sent:
            return NOTHING
        if self.follower is None:
            return Expected(self.sent)
        since = self.sent if self.follower.should_have_moved(now - self.sent) else None
        return Expected(since, self.follower.on_its_way(now, dead_times))

    def ended(self) -> bool:
        """Whether this goal can no longer move the machine."""
        return self.call is None or self.call.outcome is not None

    def wake(self) -> None:
        with self.changed:
            self.changed.notify_all()
