"""How a stand-in feels the ground that `tms:ground` keeps: soil slows its bucket, and it stands as the ground lies.

Pure logic. Without tms:ground nothing is slowed, and the ground is level at the height 0.
"""

import math
from typing import NamedTuple

from tms_config.models import MachineModel
from tms_machine.geometry import Quaternion, about, product, yaw_of
from tms_soil.resistance import speed_share

SILENT = 1.0  # s after which a resistance that was told counts no more: tms:ground is gone
JOINTS = 2  # that soil slows, those next to the bucket: of an excavator bucket and arm


class Resistance:
    """What slows a joint, or tracks: the share of the free speed that is left in the direction that met the soil."""

    def __init__(self) -> None:
        self._share, self._against = 1.0, 0.0

    def meet(self, share: float, velocity: float) -> None:
        """Take a share of the speed; `velocity` [rad/s] is the present one: a joint that stalls keeps its direction."""
        self._share = share
        if velocity:
            self._against = math.copysign(1.0, velocity)

    def slowed(self, velocity: float) -> float:
        """A velocity [rad/s] as the soil lets it be; back out of the soil it is free."""
        return velocity * self._share if velocity * self._against >= 0.0 else velocity

    def limit(self, velocity: float, free: float) -> float:
        """The fastest that the soil lets be in the direction of a velocity, of a free speed (both alike in unit)."""
        return free * self._share if self._share < 1.0 and velocity * self._against >= 0.0 else math.inf

    def braked(self, velocity: float, slowed: float) -> float:
        """A velocity [rad/s] that soil brings down at once to what it lets be."""
        into = self._share < 1.0 and velocity * self._against > 0.0 and slowed * self._against >= 0.0
        return slowed if into and abs(velocity) > abs(slowed) else velocity


class Stance(NamedTuple):
    """How a machine stands on the ground."""

    height: float  # m of map, of base_link
    # Of base_link against a machine with the same heading on level ground:
    x: float
    y: float
    z: float
    w: float


LEVEL = Stance(0.0, 0.0, 0.0, 0.0, 1.0)


def stance(height: float, turn: Quaternion) -> Stance:
    """The stance of a machine that was told with its height [m] and orientation in map."""
    return Stance(height, *product(about("z", -yaw_of(turn)), turn))


def turn_of(yaw: float, stands: Stance) -> Quaternion:
    """The orientation of base_link with a heading [rad]."""
    return product(about("z", yaw), stands[1:])


def joints_in_soil(model: MachineModel) -> tuple[str, ...]:
    """The joints that soil slows; none of a machine without a bucket."""
    if model.bucket is None:
        return ()
    joint_of = {origin.child: (joint, origin.parent) for joint, origin in model.geometry.items()}
    found, link = list[str](), model.bucket.link
    while link in joint_of and len(found) < JOINTS:
        joint, link = joint_of[link]
        if joint in model.joints and not model.joints[joint].passive:
            found.append(joint)
    return tuple(found)


class Feeling:
    """What one machine was told last."""

    def __init__(self, limit: float) -> None:
        """`limit`: force [N] that its arm and bucket can bring up."""
        self._limit, self._resistance, self._told = limit, 0.0, -math.inf
        self.stance = LEVEL

    def tell(self, now: float, resistance: float, stance: Stance) -> None:
        """Take what `tms:ground` told at a time [s]; the resistance is in N."""
        self._told, self._resistance, self.stance = now, resistance, stance

    def share(self, now: float) -> float:
        """Share of its free speed that the soil leaves to the bucket."""
        if now - self._told > SILENT:
            return 1.0
        return speed_share(self._resistance, self._limit)
