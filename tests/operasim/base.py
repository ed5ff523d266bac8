"""Where a machine is: it falls to the ground at the start, drives, and is turned by its own swing. Pure."""

import math
from dataclasses import dataclass

GRAVITY = 9.81  # m/s2


@dataclass
class Base:
    """A machine on flat ground at height 0, in the world's frame of ROS."""

    x: float
    y: float
    z: float
    yaw: float
    _falling: float = 0.0  # m/s

    def drive(self, forward: float, turn: float, seconds: float) -> None:
        """Move at these speeds [m/s, rad/s], and fall if it is above the ground."""
        self.yaw += turn * seconds
        self.x += forward * math.cos(self.yaw) * seconds
        self.y += forward * math.sin(self.yaw) * seconds
        if self.z > 0.0:
            self._falling += GRAVITY * seconds
            self.z = max(self.z - self._falling * seconds, 0.0)

    def react(self, before: float, after: float, kick: float) -> None:
        """Turn against a swing whose speed grows [rad/s]; `kick` [rad per rad/s].

        To speed up, the swing pushes harder than the ground holds; to slow down it does not.
        """
        if abs(after) > abs(before):
            self.yaw -= kick * (after - before)

    @property
    def quaternion(self) -> tuple[float, float, float, float]:
        """x, y, z, w."""
        return turned(self.yaw)


def turned(yaw: float, pitch: float = 0.0) -> tuple[float, float, float, float]:
    """The rotation about z, then about the new y, as x, y, z, w."""
    a, b = yaw / 2, pitch / 2
    return (-math.sin(a) * math.sin(b), math.cos(a) * math.sin(b), math.sin(a) * math.cos(b), math.cos(a) * math.cos(b))
