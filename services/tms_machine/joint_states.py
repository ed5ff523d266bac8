"""The last joint angles that a machine has told."""

import math
from collections.abc import Sequence

from sensor_msgs.msg import JointState

from tms_config.clock import monotonic
from tms_config.models import Border
from tms_ros.node import Ros


class JointStates:
    """Keeps the angles of some joints, by the names of the model."""

    def __init__(self, ros: Ros, machine: str, border: Border, joints: Sequence[str], depth: int = 1) -> None:
        """`depth`: messages between two calls of `take` that count; of more, the last ones."""
        self.topic = f"/{machine}/{border.joint_states}"
        self._joints, self._renamed = joints, border.joints
        self._samples = ros.sample(JointState, self.topic, depth)
        self.last: tuple[float, tuple[float, ...]] | None = None  # monotonic time [s], angles [rad]
        self.new: list[tuple[float, ...]] = []  # angles [rad] that the last `take` has found, oldest first

    def take(self) -> None:
        """Take what has come. Joint states are matched by name: backends order them differently."""
        self.new = []
        for message in self._samples():
            found = dict(zip(message.name, message.position, strict=False))
            found.update({name: found[own] for name, own in self._renamed.items() if own in found})
            angles = tuple(found.get(name, math.nan) for name in self._joints)
            if all(map(math.isfinite, angles)):
                self.last = monotonic(), angles
                self.new.append(angles)
