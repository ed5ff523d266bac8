"""Watches a machine without any process of ours in between: its controller's goals, its joint states, its receipts."""

import threading
import time
from typing import Any

from action_msgs.msg import GoalStatusArray
from sensor_msgs.msg import JointState
from tms_msg_rc.msg import StopReceipt

from tms_core.config import Site
from tms_core.ros import Ros

TOLD = (3, 5, 6)  # action_msgs/GoalStatus: CANCELING, CANCELED, ABORTED
SUCCEEDED = 4
FRESH = (0.3, 0.9)  # s after the begin of a motion, when it is on its way and will last for some time


class Eyes:
    """Of one machine with a joint trajectory controller."""

    def __init__(self, node: Ros, site: Site, machine: str) -> None:
        border, self._still = site.border(machine), site.model_of(machine).still
        self._changed = threading.Condition()
        self._begun: dict[bytes, float] = {}  # goals that were seen open, and since when
        self._over: set[bytes] = set()
        self._told_at: float | None = None
        self._slow_since: float | None = None
        self._positions: dict[str, float] = {}
        self._mark: dict[str, float] = {}
        self._marked = 0.0  # s since 1970
        self._receipts: list[Any] = []  # since the mark
        self.arrived = False  # a motion ended by itself since the mark
        self.travel = 0.0
        node.subscribe(GoalStatusArray, f"/{machine}/{border.trajectory}/_action/status", self._status, latched=True)
        node.subscribe(JointState, f"/{machine}/{border.joint_states}", self._joints, depth=10)
        node.subscribe(StopReceipt, f"/{machine}/rc/receipts", self._receipt, depth=20, latched=True)

    def mark(self) -> None:
        """Watch for a stop from now on."""
        with self._changed:
            self._told_at, self._mark, self.travel, self.arrived = None, dict(self._positions), 0.0, False
            self._marked, self._receipts = time.time(), []

    def _status(self, message: Any) -> None:
        now = time.monotonic()
        with self._changed:
            for status in message.status_list:
                goal = bytes(status.goal_info.goal_id.uuid)
                self._begun.setdefault(goal, now)
                if goal in self._over:
                    continue
                if status.status in TOLD and self._told_at is None:
                    self._told_at = now
                self.arrived = self.arrived or status.status == SUCCEEDED
                if status.status in (*TOLD, SUCCEEDED):
                    self._over.add(goal)
            self._changed.notify_all()

    def _joints(self, message: Any) -> None:
        now = time.monotonic()
        slow = all(abs(velocity) < self._still.velocity for velocity in message.velocity)
        with self._changed:
            self._positions = dict(zip(message.name, message.position, strict=False))
            if self._told_at is None or self._slow_since is None:
                apart = [abs(at - self._mark.get(name, at)) for name, at in self._positions.items()]
                self.travel = max([self.travel, *apart])
            self._slow_since = (self._slow_since or now) if slow else None
            self._changed.notify_all()

    def _receipt(self, receipt: Any) -> None:
        with self._changed:
            if receipt.stamp.sec + receipt.stamp.nanosec * 1e-9 >= self._marked:
                self._receipts.append(receipt)
            self._changed.notify_all()

    def moving(self) -> bool:
        """Whether the last joint state showed a motion."""
        return bool(self._positions) and self._slow_since is None

    def fresh(self) -> bool:
        """Whether a motion has begun a moment ago."""
        with self._changed:
            ages = [time.monotonic() - at for goal, at in self._begun.items() if goal not in self._over]
        return self.moving() and any(FRESH[0] < age < FRESH[1] for age in ages)

    def wait_told(self, seconds: float) -> float | None:
        """Monotonic time at which the controller was told to stop since the mark; None at once if it had arrived."""
        with self._changed:
            self._changed.wait_for(lambda: self._told_at is not None or self.arrived, seconds)
            return self._told_at

    def unharmed(self, seconds: float) -> bool:
        """Whether nobody told the controller to stop for that long."""
        with self._changed:
            return not self._changed.wait_for(lambda: self._told_at is not None, seconds)

    def wait_standing(self, seconds: float) -> float | None:
        """Monotonic time at which it began to stand, once it has stood for long enough."""
        with self._changed:
            self._changed.wait_for(self._standing, seconds)
            return self._slow_since if self._standing() else None

    def _standing(self) -> bool:
        return self._slow_since is not None and time.monotonic() - self._slow_since >= self._still.seconds

    def wait_receipts(self, seconds: float) -> list[Any]:
        """The gateway's receipts (tms_msg_rc/StopReceipt) of stops since the mark; empty if none came."""
        with self._changed:
            self._changed.wait_for(lambda: bool(self._receipts), seconds)
            return list(self._receipts)
