"""The goals that a planner takes, without ROS types."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tms_reason.errors import SubtaskFailed
from tms_rp.reasons import AnglesUnfit, FieldNotFinite, NamedTwice

OUT_OF_PLANE = 0.05  # rad, how far an orientation may point out of the arm's plane where a goal does not say it


@dataclass(frozen=True)
class TipGoal:
    """Bucket tip in base_link [m], bucket angle `theta_w` [rad, 0 outward, pi/2 down] and `offset` [m].

    Only excavating uses the offset: it moves the point away from the machine (positive) or towards it.
    """

    x: float
    y: float
    z: float
    theta_w: float
    offset: float = 0.0


@dataclass(frozen=True)
class LinkGoal:
    """Pose of bucket_end_link in base_link: position [m] and orientation (quaternion)."""

    x: float
    y: float
    z: float
    qx: float
    qy: float
    qz: float
    qw: float


@dataclass(frozen=True)
class Dig:
    """A place to dig, where z is the ground: how deep the tip goes below it, how far then towards the machine [m].

    `lift`: how far above the ground the bucket hangs at the end [m].
    """

    at: TipGoal
    depth: float
    drag: float
    lift: float


@dataclass(frozen=True)
class Emptying:
    """The bucket joint when open [rad], over a place or where the arm is now."""

    angle: float
    over: TipGoal | None = None


@dataclass(frozen=True)
class ChangePose:
    """Targets one after another; exactly one of the three is given.

    `joints` holds joint name -> angle [rad]; an angle beyond +-2 pi, or a joint left out, keeps its present value.
    `aside`: how far [rad] the orientation of a pose may point out of the arm's plane, which is left out then.
    """

    joints: tuple[Mapping[str, float], ...] = ()
    links: tuple[LinkGoal, ...] = ()
    tips: tuple[TipGoal, ...] = ()
    aside: float = OUT_OF_PLANE


def joint_goal(names: Sequence[str], positions: Sequence[float]) -> dict[str, float]:
    """One trajectory point as joint name -> angle [rad].

    Raises:
        SubtaskFailed: the two lists do not fit.
    """
    if len(names) != len(positions):
        raise SubtaskFailed(AnglesUnfit(len(names), len(positions)))
    if len(set(names)) != len(names):
        raise SubtaskFailed(NamedTwice(tuple(names)))
    return dict(zip(names, positions, strict=True))


def finite(field: str, *values: float) -> None:
    """Refuse NaN and infinity.

    Raises:
        SubtaskFailed: FieldNotFinite, names `field` of the goal.
    """
    if not all(math.isfinite(value) for value in values):
        raise SubtaskFailed(FieldNotFinite(field))
