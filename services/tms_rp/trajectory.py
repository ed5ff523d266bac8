"""Joint trajectories from rest to rest, as fast as position, velocity, acceleration and jerk limits allow.

Those through poses without a stop are made by blending.py.

The computation is ruckig's, move by move. Its intermediate waypoints are not used: they would be sent to a
remote service, and a machine must not depend on one. The stops between the moves are wanted anyway.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from ruckig import InputParameter, Result, Ruckig, RuckigError, Synchronization
from ruckig import Trajectory as Profile

from tms_config.models import Joint
from tms_reason.errors import SubtaskFailed
from tms_rp.reasons import LimitsLeft, NoTrajectory

STEP = 0.05  # s, at most, between two samples
ROUNDING = 1e-6  # share of the limit that floating-point arithmetic may add

Joints = tuple[float, ...]


@dataclass(frozen=True)
class TrajectorySample:
    """State of all joints at one time [s] from the start; rad, rad/s, rad/s^2."""

    time: float
    positions: Joints
    velocities: Joints
    accelerations: Joints


@dataclass(frozen=True)
class Trajectory:
    """Samples of one or more moves, the last of which ends at rest."""

    names: tuple[str, ...]
    samples: tuple[TrajectorySample, ...]
    stops: tuple[float, ...]  # s, when each move ends, at rest or in motion

    @property
    def duration(self) -> float:
        """Seconds from start to end."""
        return self.samples[-1].time

    def then(self, other: "Trajectory") -> "Trajectory":
        """The same, then another one that begins at rest where it ends."""
        later = [replace(sample, time=sample.time + self.duration) for sample in other.samples[1:]]
        stops = (*self.stops, *(stop + self.duration for stop in other.stops))
        return replace(self, samples=(*self.samples, *later), stops=stops)

    def since(self, seconds: float) -> "Trajectory":
        """The samples from a time [s] on; their times stay."""
        return replace(self, samples=tuple(sample for sample in self.samples if sample.time >= seconds))

    def lagging(self, late: Sequence[float]) -> "Trajectory":
        """The positions on the way when each joint is late by a time of its own [s]; it has no velocities."""
        times = [sample.time for sample in self.samples]
        end = self.duration + max(late)
        seconds = [*times, *np.linspace(self.duration, end, math.ceil(max(late) / STEP) + 1)[1:]]
        ways = zip(*(sample.positions for sample in self.samples), strict=True)
        moved = [np.interp(np.array(seconds) - by, times, way) for by, way in zip(late, ways, strict=True)]
        return replace(
            self, samples=tuple(_rest(float(at), tuple(map(float, one)))
                                for at, one in zip(seconds, np.transpose(moved), strict=True)),
        )  # fmt: skip

    def progress(self, seconds: float) -> tuple[int, int]:
        """Number of the move, from 1, and percent of it, at a time from the start."""
        begin = 0.0
        for number, end in enumerate(self.stops, 1):
            if seconds < end or number == len(self.stops):
                done = (seconds - begin) / (end - begin) if end > begin else 1.0
                return number, round(100 * max(0.0, min(1.0, done)))
            begin = end
        return 0, 100


def trajectory(
    joints: dict[str, Joint],
    start: Sequence[float],
    targets: Sequence[Sequence[float]],
    step: float = STEP,
    straight: bool = False,
) -> Trajectory:
    """The trajectory from `start` [rad] over `targets` [rad], at rest in each; joint order is that of `joints`.

    `straight`: each move is a straight line in joint space, also where that costs time. A move between equal poses
    takes no time. A start outside its limits is allowed, so that a joint that sags past its bound can come back; it
    never gets further out.

    Raises:
        SubtaskFailed: NoTrajectory, LimitsLeft: no trajectory keeps the limits.
    """
    limits = tuple(joints.values())
    samples = [_rest(0.0, tuple(start))]
    stops = []
    for target in targets:
        samples += _move(limits, samples[-1], tuple(target), step, straight)
        stops.append(samples[-1].time)
    if len(samples) == 1:  # no joint moves: a controller still needs a second point
        samples.append(_rest(step, samples[0].positions))
    check_limits(joints, samples, targets)
    return Trajectory(tuple(joints), tuple(samples), tuple(stops))


def _rest(time: float, positions: Joints) -> TrajectorySample:
    still = (0.0,) * len(positions)
    return TrajectorySample(time, positions, still, still)


def _move(
    limits: Sequence[Joint], begin: TrajectorySample, target: Joints, step: float, straight: bool
) -> list[TrajectorySample]:
    """Samples after `begin` up to the rest in `target`."""
    if all(abs(a - b) < 1e-9 for a, b in zip(begin.positions, target, strict=True)):
        return []
    slowed = _in_proportion(limits, begin.positions, target) if straight else limits
    profile = _profile(slowed, begin.positions, target)
    count = math.ceil(profile.duration / step)
    samples = []
    for i in range(1, count):
        seconds = profile.duration * i / count
        p, v, a = profile.at_time(seconds)
        samples.append(TrajectorySample(begin.time + seconds, tuple(p), tuple(v), tuple(a)))
    return [*samples, _rest(begin.time + profile.duration, target)]


def _in_proportion(limits: Sequence[Joint], start: Joints, target: Joints) -> Sequence[Joint]:
    """Limits in the proportion of the ways of the joints: with them all joints have the same profile."""
    ways = [abs(b - a) for a, b in zip(start, target, strict=True)]

    def shared(limit: str) -> float:
        return min(float(getattr(joint, limit)) / way for joint, way in zip(limits, ways, strict=True) if way > 0)

    most = {limit: shared(limit) for limit in ("velocity", "acceleration", "jerk")}
    return [
        joint.model_copy(update={limit: value * way for limit, value in most.items()}) if way > 0 else joint
        for joint, way in zip(limits, ways, strict=True)
    ]


def _profile(limits: Sequence[Joint], start: Joints, target: Joints) -> Profile:
    size = len(limits)
    wanted, profile = InputParameter(size), Profile(size)
    wanted.current_position, wanted.target_position = list(start), list(target)
    wanted.max_velocity = [joint.velocity for joint in limits]
    wanted.max_acceleration = [joint.acceleration for joint in limits]
    wanted.max_jerk = [joint.jerk for joint in limits]
    # Straight in joint space where that costs no time: easier to foresee than joints that only arrive together.
    wanted.synchronization = Synchronization.Phase
    try:
        result = Ruckig(size).calculate(wanted, profile)
    except RuckigError as error:
        raise SubtaskFailed(NoTrajectory(" ".join(str(error).split()))) from error
    if result not in (Result.Working, Result.Finished):
        raise SubtaskFailed(NoTrajectory(result.name))
    return profile


def check_limits(
    joints: dict[str, Joint], samples: Sequence[TrajectorySample], targets: Sequence[Sequence[float]]
) -> None:
    """Refuse samples outside the limits, whoever made them.

    Raises:
        SubtaskFailed: LimitsLeft.
    """
    for i, (name, joint) in enumerate(joints.items()):
        reached = [samples[0].positions[i], *(target[i] for target in targets)]
        low = min(reached) if joint.min is None else min(joint.min, *reached)
        high = max(reached) if joint.max is None else max(joint.max, *reached)
        for sample in samples:
            inside = low - ROUNDING <= sample.positions[i] <= high + ROUNDING
            slow = abs(sample.velocities[i]) <= joint.velocity * (1 + ROUNDING)
            gentle = abs(sample.accelerations[i]) <= joint.acceleration * (1 + ROUNDING)
            if not (inside and slow and gentle):
                raise SubtaskFailed(LimitsLeft(name, sample.time))
