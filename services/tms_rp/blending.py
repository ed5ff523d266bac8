"""Trajectories through poses without a stop.

The nominal motion goes straight from pose to pose, each line at constant speeds. What is driven is its moving average,
taken twice for each joint: the first window bounds the joint's acceleration, the second one its jerk (the method of FIR
filters: Biagiotti and Melchiorri, 2012). An average lies between what it is taken of: positions stay between those of
the poses, velocities within those of the lines, so only accelerations and jerks need a look. Corners are rounded as far
as the joints need it, and time is lost for braking and starting once, not at each pose.

Two moving averages are differences of the second integral of the nominal motion, which is known exactly.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tms_config.models import Joint
from tms_rp.trajectory import STEP, Joints, Trajectory, TrajectorySample, check_limits, trajectory

SIGNS = (1.0, -1.0, -1.0, 1.0)  # of the four differences
GROWTH = 1.01  # least factor by which a window that is too short grows
SLIVER = 1e-6  # s; times that differ by less are the same
STILL = 1e-9  # rad; a joint that goes less far does not move: its windows would be as good as nothing

Array = NDArray[np.float64]


@dataclass(frozen=True)
class _Line:
    """The nominal motion of one joint: angles [rad] at times [s], straight between, at rest before and after."""

    times: Array
    angles: Array  # less the first one

    def at(self, times: Array) -> tuple[Array, Array, Array, Array]:
        """Speed, angle, and the first and second integral of the angle, at times."""
        gaps, steps = np.diff(self.times), np.diff(self.angles)
        speeds = np.append(np.divide(steps, gaps, out=np.zeros_like(steps), where=gaps > 0), 0.0)
        first = np.concatenate([[0.0], np.cumsum(gaps * (self.angles[:-1] + steps / 2))])
        second = np.concatenate([[0.0], np.cumsum(gaps * (first[:-1] + gaps * (self.angles[:-1] / 2 + steps / 6)))])
        since = np.maximum(times, self.times[0])
        i = np.searchsorted(self.times, since, side="right") - 1
        x, v, q, f, g = since - self.times[i], speeds[i], self.angles[i], first[i], second[i]
        moving = np.where(times < self.times[0], 0.0, v)
        return moving, q + v * x, f + x * (q + v * x / 2), g + x * (f + x * (q / 2 + v * x / 6))


@dataclass(frozen=True)
class _Averaged:
    """The motion of one joint: its line, averaged over two windows [s]."""

    line: _Line
    first: float
    second: float

    @property
    def half(self) -> float:
        """How long before a corner of its line it begins to turn, and after it ends [s]."""
        return (self.first + self.second) / 2

    def at(self, times: Array) -> tuple[Array, Array, Array, Array]:
        """Jerk, acceleration, velocity and angle at times."""
        a, b = self.first / 2, self.second / 2
        parts = [self.line.at(times + shift) for shift in (a + b, a - b, b - a, -a - b)]
        jerk, force, speed, angle = (
            sum(sign * part for sign, part in zip(SIGNS, four, strict=True)) / (self.first * self.second)
            for four in zip(*parts, strict=True)
        )
        return jerk, force, speed, angle

    def peaks(self) -> tuple[float, float]:
        """The largest acceleration and jerk: the one is straight between the corners, the other constant."""
        a, b = self.first / 2, self.second / 2
        corners = np.sort(np.concatenate([self.line.times + shift for shift in (a + b, a - b, b - a, -a - b)]))
        middles = (corners[1:] + corners[:-1]) / 2
        jerks = np.abs(self.at(middles)[0][np.diff(corners) > SLIVER])
        return float(np.abs(self.at(corners)[1]).max()), float(jerks.max(initial=0.0))


def blended(
    joints: Mapping[str, Joint], poses: Sequence[Joints], least: Sequence[float], step: float = STEP
) -> Trajectory:
    """The trajectory through poses [rad], at rest in the first and the last; its `stops` are when it passes each.

    The joints are in the order of `joints`. `least`: how long [s] each line takes at least. Poses in between are passed
    at the distance that the accelerations of the joints need.

    Raises:
        SubtaskFailed: LimitsLeft.
    """
    angles = np.array(poses, dtype=float)
    times = np.concatenate([[0.0], np.cumsum(_durations(joints, angles, least))])
    moved = {
        i: _averaged(_Line(times, angles[:, i] - angles[0, i]), joint)
        for i, joint in enumerate(joints.values())
        if np.ptp(angles[:, i]) > STILL
    }
    if not moved:
        return trajectory(dict(joints), poses[0], list(poses[1:]))
    begin = min(times[np.flatnonzero(np.diff(one.line.angles))[0]] - one.half for one in moved.values())
    end = max(times[np.flatnonzero(np.diff(one.line.angles))[-1] + 1] + one.half for one in moved.values())
    count = math.ceil((end - begin) / step)
    samples = _samples(moved, np.linspace(begin, end, count + 1), angles)
    check_limits(dict(joints), samples, poses[1:])
    passed = np.clip(times[1:] - begin, 0.0, end - begin)
    return Trajectory(tuple(joints), tuple(samples), (*map(float, passed[:-1]), float(end - begin)))


def _durations(joints: Mapping[str, Joint], angles: Array, least: Sequence[float]) -> Array:
    """How long each line takes [s]: its slowest joint at its speed.

    A joint that cannot reach its full speed on the way that it has in one direction gets the speed with which it needs
    the least time for it.
    """
    steps = np.diff(angles, axis=0)
    found = np.array(least, dtype=float)
    for i, joint in enumerate(joints.values()):
        turns = np.flatnonzero(np.diff(np.sign(steps[:, i]))) + 1
        for run in np.split(np.arange(len(steps)), turns):
            ways = np.abs(steps[run, i])
            speed = min(joint.velocity, math.sqrt(joint.acceleration * ways.sum()))
            if speed > 0:
                found[run] = np.maximum(found[run], ways / speed)
    return found


def _averaged(line: _Line, joint: Joint) -> _Averaged:
    """The line with the shortest windows found that keep the limits; as long as all its speeds need at most."""
    gaps = np.diff(line.times)
    speeds = np.concatenate([[0.0], np.diff(line.angles)[gaps > 0] / gaps[gaps > 0], [0.0]])
    spread = float(np.ptp(speeds))
    longest = spread / joint.acceleration
    first, second = float(np.abs(np.diff(speeds)).max()) / joint.acceleration, joint.acceleration / joint.jerk
    while True:
        found = _Averaged(line, first, second)
        force, jerk = found.peaks()
        most = 2 * spread / (first * joint.jerk)
        if force > joint.acceleration and first < longest:
            first = min(longest, first * max(GROWTH, force / joint.acceleration))
        elif jerk > joint.jerk and second < most:
            second = min(most, second * max(GROWTH, jerk / joint.jerk))
        else:
            return found


def _samples(moved: Mapping[int, _Averaged], times: Array, angles: Array) -> list[TrajectorySample]:
    """The samples at times, from 0; the first and the last are exactly the poses there."""
    shape = len(times), angles.shape[1]
    forces, speeds, places = np.zeros(shape), np.zeros(shape), np.tile(angles[0], (len(times), 1))
    for i, one in moved.items():
        _, forces[:, i], speeds[:, i], way = one.at(times)
        places[:, i] += way
    for at, pose in ((0, angles[0]), (-1, angles[-1])):
        places[at], speeds[at], forces[at] = pose, 0.0, 0.0
    low, high = angles.min(axis=0), angles.max(axis=0)
    rows = zip(times - times[0], np.clip(places, low, high).tolist(), speeds.tolist(), forces.tolist(), strict=True)
    return [TrajectorySample(float(at), tuple(q), tuple(v), tuple(a)) for at, q, v, a in rows]
