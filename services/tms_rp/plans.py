"""Stored plans: whether they fit the machine as it is now, and all of them as one trajectory."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_config.models import Joint
from tms_control.links import Array
from tms_machine.stamps import seconds
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.blending import blended
from tms_rp.kind import Angles
from tms_rp.reasons import JointBroken, PlanBroken, PlanElsewhere, PlanLacks, PlanTooFast, PlanWrong
from tms_rp.trajectory import Joints, Trajectory, TrajectorySample, trajectory

START = 0.1  # rad from the arm, or from the end of the plan before, to a plan's begin: joints droop and sag
MARGIN = 1.01  # times a limit that a plan may reach: records round their figures
REST = 1e-3  # rad/s
APART = 0.005  # rad between two poses of a path: points of records that are nearer differ by their rounding, too
ROUNDED = 1e-3  # rad/s that speeds between two points may be off: records round angles


def start_of(previous: JointTrajectory, names: Sequence[str]) -> Angles | None:
    """Where a plan begins that goes on from another one; None without that one.

    Raises:
        SubtaskFailed: PlanWrong.
    """
    if not previous.points:
        return None
    last = dict(zip(previous.joint_names, previous.points[-1].positions, strict=False))
    angles = tuple(last.get(name, math.nan) for name in names)
    if not all(map(math.isfinite, angles)):
        raise SubtaskFailed(PlanWrong(1, PlanLacks(tuple(name for name in names if name not in last))))
    return angles


def one_trajectory(joints: dict[str, Joint], now: Joints, plans: Sequence[JointTrajectory]) -> Trajectory:
    """The plans one behind the other; before each, a move from rest to rest to its begin. Collisions are not looked at.

    Raises:
        SubtaskFailed: PlanWrong; a plan breaks a limit, or does not begin where the arm is by then.
    """
    samples, stops = list(trajectory(joints, now, ()).samples[:1]), list[float]()
    for number, plan in enumerate(plans, 1):
        arm = samples[-1]
        found = _samples(joints, arm.positions, plan)
        wrong = found if isinstance(found, Reason) else _problem(joints, arm.positions, found)
        if wrong is not None or isinstance(found, Reason):
            raise SubtaskFailed(PlanWrong(number, wrong or PlanBroken()))
        towards = trajectory(joints, arm.positions, [found[0].positions])
        if towards.stops[-1] > 0:
            samples += _later(towards.samples[1:], arm.time)
        samples += _later(found[1:], samples[-1].time - found[0].time)
        stops.append(samples[-1].time)
    return Trajectory(tuple(joints), tuple(samples), tuple(stops))


def without_stops(joints: Mapping[str, Joint], made: Trajectory) -> Trajectory:
    """Plans one behind the other without the stops between them: on their path but for its corners, no faster.

    Raises:
        SubtaskFailed: LimitsLeft.
    """
    poses, least, ends, plan = [made.samples[0].positions], list[float](), list[int](), 0
    speeds = _speeds(made)
    for sample in made.samples[1:]:
        ways = np.abs(np.subtract(sample.positions, poses[-1]))
        if (ended := sample.time >= made.stops[plan]) or ways.max() > APART:
            peak = np.where(speeds[plan] > 0, speeds[plan], math.inf)
            poses.append(sample.positions)
            least.append(float((ways / peak).max()))
        if ended:
            ends.append(len(poses) - 2)
            plan += 1
    forces = np.abs([sample.accelerations for sample in made.samples]).max(axis=0)
    gentle = dict(zip(joints, map(_gentle, joints.values(), map(float, forces)), strict=True))
    found = blended(gentle, poses, least)
    return replace(found, stops=tuple(found.stops[end] for end in ends))


def _speeds(made: Trajectory) -> list[Array]:
    """The highest speed of each joint [rad/s] in each plan."""
    times = np.array([sample.time for sample in made.samples])
    speeds = np.abs(np.diff([sample.positions for sample in made.samples], axis=0)) / np.diff(times)[:, None]
    begins = (0.0, *made.stops[:-1])
    spans = zip(begins, made.stops, strict=True)
    return [speeds[(times[1:] > begin) & (times[1:] <= end)].max(axis=0) for begin, end in spans]


def _gentle(joint: Joint, force: float) -> Joint:
    """The joint with at most this acceleration, if it is known."""
    share = min(1.0, force / joint.acceleration) or 1.0
    return joint.model_copy(update={"acceleration": joint.acceleration * share, "jerk": joint.jerk * share})


def scaled(joints: Mapping[str, Joint], velocity: float, acceleration: float) -> dict[str, Joint]:
    """Joints whose limits are shares of these; jerk goes with the acceleration."""
    return {
        name: joint.model_copy(
            update={
                "velocity": joint.velocity * velocity,
                "acceleration": joint.acceleration * acceleration,
                "jerk": joint.jerk * acceleration,
            }
        )
        for name, joint in joints.items()
    }


def _samples(joints: Mapping[str, Joint], now: Joints, plan: JointTrajectory) -> list[TrajectorySample] | Reason:
    """The points of a plan for all joints; passive ones may be left out, and stay."""
    names = list(plan.joint_names)
    lacks = tuple(name for name, joint in joints.items() if name not in names and not joint.passive)
    if lacks or not set(names) <= set(joints) or len(set(names)) < len(names):
        return PlanLacks(lacks)
    still = dict(zip(joints, now, strict=True))
    found: list[TrajectorySample] = []
    for point in plan.points:
        sample = _sample(names, still, point)
        if sample is None:
            return PlanBroken()
        found.append(sample)
    return found if len(found) > 1 else PlanBroken()


def _sample(names: Sequence[str], still: Mapping[str, float], point: JointTrajectoryPoint) -> TrajectorySample | None:
    """A point in the order of the joints; None if it is no point of a plan."""
    parts = [list(part) for part in (point.positions, point.velocities, point.accelerations)]
    parts[1:] = [part or [0.0] * len(names) for part in parts[1:]]
    if any(len(part) != len(names) or not all(map(math.isfinite, part)) for part in parts):
        return None
    at, speed, force = (dict(zip(names, part, strict=True)) for part in parts)
    return TrajectorySample(
        seconds(point.time_from_start),
        tuple(at.get(name, angle) for name, angle in still.items()),
        tuple(speed.get(name, 0.0) for name in still),
        tuple(force.get(name, 0.0) for name in still),
    )


def _problem(joints: Mapping[str, Joint], arm: Joints, samples: Sequence[TrajectorySample]) -> Reason | None:
    first = samples[0]
    if any(abs(speed) > REST for speed in (*first.velocities, *samples[-1].velocities)):
        return PlanBroken()
    for (name, joint), begin, angle in zip(joints.items(), first.positions, arm, strict=True):
        if abs(begin - angle) > START:
            return PlanElsewhere(name, begin, angle)
        if (outside := _outside(joint, begin, angle)) is not None:
            return JointBroken(name, outside)
    speeds, last = (0.0,) * len(joints), 0.0
    for before, now in pairwise(samples):
        if (passed := now.time - before.time) <= 0:
            return PlanBroken()
        old, speeds = speeds, tuple((b - a) / passed for a, b in zip(before.positions, now.positions, strict=True))
        for index, (name, joint) in enumerate(joints.items()):
            if (outside := _outside(joint, now.positions[index], arm[index])) is not None:
                return JointBroken(name, outside)
            gained = abs(speeds[index] - old[index]) - ROUNDED
            fast = max(abs(now.velocities[index]), abs(speeds[index])) > joint.velocity * MARGIN
            hard = max(abs(now.accelerations[index]), 2 * gained / (passed + last)) > joint.acceleration * MARGIN
            if fast or hard:
                return PlanTooFast(name, now.time)
        last = passed
    return None


def _outside(joint: Joint, angle: float, arm: float) -> Reason | None:
    """Which bound an angle [rad] breaks; where the joint of the arm sags beyond one, a plan goes no further."""
    outside = joint.violation(angle)
    if outside is None or joint.violation(arm) is None:
        return outside
    low, high = (arm if bound is None else bound for bound in (joint.min, joint.max))
    return None if min(arm, low) <= angle <= max(arm, high) else outside


def _later(samples: Sequence[TrajectorySample], by: float) -> list[TrajectorySample]:
    return [replace(sample, time=sample.time + by) for sample in samples]
