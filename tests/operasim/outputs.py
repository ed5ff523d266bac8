"""What a machine tells, and how often. Pure."""

import math
import struct
from collections.abc import Callable

from operasim import messages
from operasim.base import GRAVITY, turned
from operasim.machine import Machine
from operasim.messages import Place
from operasim.model import Output, OutputKind

WHEELS = (0.001, 0.001, 1e6, 1e6, 1e6, 1000.0)  # covariances of odometry
TRUTH = (0.5, 0.5, 0.5, 0.1, 0.1, 0.1)
# Where both scenes lie on the earth: of this point of ROS, taken as x north, y west.
LATITUDE, LONGITUDE, ALTITUDE = 36.073406033, 140.041676353, 68.2
ORIGIN = (53.8, -53.19, 50.16)
EARTH = 6378137.0  # m


def single(value: float) -> float:
    """The nearest value in single precision, which the engine has."""
    return float(struct.unpack("f", struct.pack("f", value))[0])


class Interval:
    """Says when a message is due. It adds steps in single precision and begins at 0 again.

    So of a period of 0.1 s six steps of 20 ms become, not five.
    """

    def __init__(self, period: float) -> None:
        self._period, self._passed = single(period), 0.0

    def due(self, seconds: float) -> bool:
        """Whether it is, a step later."""
        self._passed = single(self._passed + single(seconds))
        if self._passed < self._period:
            return False
        self._passed = 0.0
        return True


def named(one: Output, name: str) -> Output:
    """It with the frames of the machine of this name."""
    return one.model_copy(update={"frame": one.frame.format(name=name), "child": one.child.format(name=name)})


def tell(machine: Machine, one: Output, now: float) -> bytes:
    """The message as of now."""
    return TOLD[one.kind](machine, one, now)


def _joint_state(machine: Machine, one: Output, now: float) -> bytes:
    joints = [
        (name, single(drive.position), single(drive.velocity)) if drive is not None else (name, 0.0, 0.0)
        for name, drive in machine.joints.items()
    ]
    return messages.joint_state(now, one.frame, joints)


def _odometry(machine: Machine, one: Output, now: float) -> bytes:
    tracks = machine.tracks
    x, y, yaw = tracks.odometry
    place = Place((single(x), single(y), 0.0), turned(yaw))
    return messages.odometry(now, (one.frame, one.child), place, (tracks.forward, tracks.odometry_turn), WHEELS)


def _pose(machine: Machine, one: Output, now: float) -> bytes:
    return messages.pose(now, one.frame, _place(machine))


def _global_pose(machine: Machine, one: Output, now: float) -> bytes:
    return messages.global_pose(now, one.frame, _place(machine), TRUTH)


def _imu(machine: Machine, one: Output, now: float) -> bytes:
    swing, *pitching = [drive for name in one.joints if (drive := machine.joints[name]) is not None]
    pitch = sum(drive.position for drive in pitching)
    turn, tilt = swing.velocity, sum(drive.velocity for drive in pitching)
    yaw = machine.base.yaw + swing.position
    turning = (-turn * math.sin(pitch), tilt, turn * math.cos(pitch))
    pushed = (-GRAVITY * math.sin(pitch), 0.0, GRAVITY * math.cos(pitch))
    return messages.imu(now, one.frame, turned(yaw, pitch), turning, pushed)


def _fix(machine: Machine, one: Output, now: float) -> bytes:
    north, west, up = (a - b for a, b in zip(_place(machine).position, ORIGIN, strict=True))
    latitude = LATITUDE + math.degrees(north / EARTH)
    longitude = LONGITUDE - math.degrees(west / (EARTH * math.cos(math.radians(LATITUDE))))
    return messages.fix(now, one.frame, latitude, longitude, ALTITUDE + up)


def _heading(machine: Machine, one: Output, now: float) -> bytes:
    return messages.heading(now, one.frame, machine.base.quaternion)


def _place(machine: Machine) -> Place:
    base = machine.base
    return Place((single(base.x), single(base.y), single(base.z)), base.quaternion)


TOLD: dict[OutputKind, Callable[[Machine, Output, float], bytes]] = {
    "joint_state": _joint_state, "odometry": _odometry, "pose": _pose, "global_pose": _global_pose, "imu": _imu,
    "fix": _fix, "heading": _heading,
}  # fmt: skip
