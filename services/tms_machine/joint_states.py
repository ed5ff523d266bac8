"""The last joint angles that a machine has told."""

import math
from collections.abc import Sequence

from sensor_msgs.msg import JointState

from tms_config.clock import monotonic
from tms_config.models import Border
from tms_ros.node import Ros


class JointStates:
    """Keeps the angles of some joints, by the names of the model."""

    def __init__(self, ros: Ros, machine: str, border: Border, joints: Sequence[str]) -> None:
        self.topic = f"/{machine}/{border.joint_states}"
        self._joints, self._renamed = joints, border.joints
        self._samples = ros.sample(JointState, self.topic)
        self.last: tuple[float, tuple[float, ...]] | None = None  # monotonic time [s], angles [rad]

    def take(self) -> None:
        """Take what has come. Joint states are matched by name: backends order them differently."""
        for message in self._samples():
            found = dict(zip(message.name, message.position, strict=False))
            found.update({name: found[own] for name, own in self._renamed.items() if own in found})
            angles = tuple(found.get(name, math.nan) for name in self._joints)
            if all(map(math.isfinite, angles)):
                self.last = monotonic(), angles
