"""Records that name places: one pose or a path, oriented by quaternions or by degrees."""

import math
from typing import Literal

from geometry_msgs.msg import Point, Pose, Quaternion
from pydantic import model_validator

from tms_kit.subtask import Params
from tms_machine import geometry
from tms_machine.reasons import FieldMissing, ListsDiffer, NoUnitLength, PathEmpty
from tms_reason.validation import Wrong

Angles = Literal["quaternion", "degrees"]
TURN = {"quaternion": ("qx", "qy", "qz", "qw"), "degrees": ("yaw",)}


class PoseRecord(Params):
    """One pose in `map`; z is ignored, since the machine stands on the ground."""

    angles: Angles = "quaternion"  # an input of the variant
    x: float  # m
    y: float  # m
    qx: float | None = None
    qy: float | None = None
    qz: float | None = None
    qw: float | None = None
    yaw: float | None = None  # deg

    @model_validator(mode="after")
    def _complete(self) -> "PoseRecord":
        names = TURN[self.angles]
        for name in names:
            if getattr(self, name) is None:
                raise Wrong(FieldMissing(name))
        turn(*(getattr(self, name) for name in names))
        return self

    def pose(self) -> Pose:
        """The pose as a ROS message."""
        numbers = [getattr(self, name) for name in TURN[self.angles]]
        return Pose(position=Point(x=self.x, y=self.y), orientation=turn(*numbers))


class PathRecord(Params):
    """Poses in `map`, one list a coordinate, all of one length."""

    angles: Angles = "quaternion"  # an input of the variant
    x: list[float]  # m
    y: list[float]  # m
    z: list[float]  # m
    qx: list[float] | None = None
    qy: list[float] | None = None
    qz: list[float] | None = None
    qw: list[float] | None = None
    yaw: list[float] | None = None  # deg
    read_direction: str = ""  # down: from the last pose to the first; else from the first to the last

    @model_validator(mode="after")
    def _fits(self) -> "PathRecord":
        lengths = {name: len(self._list(name)) for name in ("x", "y", "z", *TURN[self.angles])}
        if len(set(lengths.values())) != 1:
            reported = ", ".join(f"{name} {length}" for name, length in lengths.items())
            raise Wrong(ListsDiffer(reported))
        if not self.x:
            raise Wrong(PathEmpty())
        self.poses()
        return self

    def poses(self) -> list[Pose]:
        """The poses as ROS messages."""
        places = zip(self.x, self.y, self.z, strict=True)
        turns = zip(*(self._list(name) for name in TURN[self.angles]), strict=True)
        poses = [
            Pose(position=Point(x=x, y=y, z=z), orientation=turn(*numbers))
            for (x, y, z), numbers in zip(places, turns, strict=True)
        ]
        return poses[::-1] if self.read_direction == "down" else poses

    def _list(self, name: str) -> list[float]:
        found: list[float] | None = getattr(self, name)
        if found is None:
            raise Wrong(FieldMissing(name))
        return found


def turn(*numbers: float) -> Quaternion:
    """Orientation from qx, qy, qz, qw, or from one yaw [deg].

    Raises:
        Wrong: the four numbers are no quaternion.
    """
    if len(numbers) == 1:
        x, y, z, w = geometry.about("z", math.radians(numbers[0]))
        return Quaternion(x=x, y=y, z=z, w=w)
    x, y, z, w = numbers
    if not geometry.is_orientation((x, y, z, w)):
        raise Wrong(NoUnitLength(f"{geometry.length((x, y, z, w)):.3f}"))
    x, y, z, w = geometry.unit((x, y, z, w))
    return Quaternion(x=x, y=y, z=z, w=w)
