"""Checks motions against the machine model, before they leave and while they run. Pure logic."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tms_config.models import MachineModel
from tms_config.reasons import AboveLimit, BelowLimit
from tms_machine.geometry import is_orientation, length
from tms_machine.reasons import NoSuchJoint
from tms_rc.reasons import (
    AtJoint,
    AtPoint,
    AtPose,
    BadQuaternion,
    Escaped,
    JointTwice,
    NoNumber,
    NoPoints,
    NoPose,
    NothingTurns,
    RestNoNumber,
    TimeNotAfter,
    TooFast,
    WrongLength,
)
from tms_reason.reason import Reason

SPEED_MARGIN = 1.1  # times the limit of speed that a trajectory may ask for
UNHEARD = 0.2  # s; a joint may be as far from the start of its trajectory as it can go in this time
ANGLE_EPSILON = 1e-4  # rad
MARGIN = 0.05  # rad that a moving joint may be measured beyond a limit, and further out than at the start


def problem(
    model: MachineModel,
    joints: Sequence[str],
    points: Sequence[Sequence[float]],
    present: Mapping[str, float] | None = None,
) -> Reason | None:
    """What is wrong with a trajectory (points x joints, rad), with the joint and the bound; None if nothing.

    `present` are the joints now [rad]: a joint that sags beyond its limit must be able to come back, so points no
    further out than its present angle are allowed.
    """
    unknown = [name for name in joints if name not in model.joints]
    if unknown:
        return NoSuchJoint(unknown[0], tuple(model.joints))
    if len(set(joints)) < len(joints):
        return JointTwice(tuple(joints))
    if not points:
        return NoPoints()
    for number, point in enumerate(points):
        if len(point) != len(joints):
            return AtPoint(number, WrongLength(len(point), len(joints)))
        for name, angle in zip(joints, point, strict=True):
            broken = NoNumber() if not math.isfinite(angle) else model.joints[name].violation(angle)
            if broken and not _inside(model, name, angle, (present or {}).get(name)):
                return _at(number, len(points), AtJoint(name, broken))
    return None


@dataclass(frozen=True)
class TrajectoryPoint:
    """One point of a trajectory."""

    time: float  # s from the start
    positions: Sequence[float]  # rad
    rest: Sequence[float]  # velocities, accelerations and efforts, as far as they are given


def pace_problem(
    model: MachineModel,
    joints: Sequence[str],
    points: Sequence[TrajectoryPoint],
    present: Mapping[str, float],
    speed: float = 1.0,
) -> Reason | None:
    """What is wrong with the times of a trajectory whose positions are right; `present` are the joints now [rad].

    Between two points a joint may go at most a little faster than its limit of speed: planners round their figures.
    `speed` is that of a simulated machine: since its last message, it may have gone `speed` times further.
    """
    before, unreceived = TrajectoryPoint(0.0, [present.get(name, math.nan) for name in joints], []), UNHEARD * speed
    for number, point in enumerate(points):
        if not all(map(math.isfinite, point.rest)):
            return _at(number, len(points), RestNoNumber())
        passed = point.time - before.time
        if passed < 0 or (passed == 0 and number > 0):
            return _at(number, len(points), TimeNotAfter(point.time))
        for name, old, new in zip(joints, before.positions, point.positions, strict=True):
            allowed = model.joints[name].velocity * (SPEED_MARGIN * passed + unreceived) + ANGLE_EPSILON
            if abs(new - old) > allowed:  # false where the joint's place is unknown
                fast = TooFast(abs(new - old), passed, model.joints[name].velocity)
                return _at(number, len(points), AtJoint(name, fast))
        before, unreceived = point, 0.0
    return None


def _at(number: int, count: int, why: Reason) -> Reason:
    """Name the point, unless the trajectory has only one."""
    return AtPoint(number, why) if count > 1 else why


def angle_problem(model: MachineModel, action: str, angle: float, present: Mapping[str, float]) -> Reason | None:
    """What is wrong with the angle [rad] of an action that turns one joint."""
    joint = model.turned(action)
    if joint is None:
        return NothingTurns(action)
    return problem(model, [joint], [[angle]], present)


def pose_problem(poses: Sequence[tuple[float, ...]]) -> Reason | None:
    """What is wrong with poses as x, y, z [m], qx, qy, qz, qw; a navigation would accept them and go somewhere."""
    if not poses:
        return NoPose()
    for number, pose in enumerate(poses):
        if not all(map(math.isfinite, pose)):
            return AtPose(number, NoNumber())
        qx, qy, qz, qw = pose[3:]
        if not is_orientation((qx, qy, qz, qw)):
            return AtPose(number, BadQuaternion(length((qx, qy, qz, qw))))
    return None


def _inside(model: MachineModel, name: str, angle: float, present: float | None) -> bool:
    """Whether an angle beyond a limit is on the same side as the joint now, and no further out."""
    if present is None or not math.isfinite(angle):
        return False
    joint = model.joints[name]
    if joint.min is not None and angle < joint.min:
        return present <= angle + 1e-6
    return joint.max is not None and angle > joint.max and present >= angle - 1e-6


def escaped(model: MachineModel, now: Mapping[str, float], start: Mapping[str, float]) -> Reason | None:
    """The joint that a running motion has taken out of its limits; `start` is where the motion began."""
    for name, angle in now.items():
        joint, began = model.joints[name], start.get(name, 0.0)
        if joint.min is not None and angle < min(joint.min, began) - MARGIN:
            return Escaped(name, BelowLimit(angle, joint.min))
        if joint.max is not None and angle > max(joint.max, began) + MARGIN:
            return Escaped(name, AboveLimit(angle, joint.max))
    return None
