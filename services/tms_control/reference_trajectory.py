"""The reference that a trajectory controller interpolates between the points of a goal. Pure logic."""

import bisect
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tms_config.models import Joint
from tms_control.reasons import OtherJoints, PointNotFinite, PointTooEarly, PointUnfit, TrajectoryEmpty
from tms_reason.reason import Reason

INVALID_GOAL, INVALID_JOINTS = -1, -2  # control_msgs/FollowJointTrajectory result codes


@dataclass(frozen=True)
class Knot:
    """One point of a trajectory: time [s] from its start, rad, rad/s (empty: not given)."""

    time: float
    positions: tuple[float, ...]
    velocities: tuple[float, ...] = ()


def refusal(joints: Mapping[str, Joint], names: Sequence[str], points: Sequence[Knot]) -> tuple[int, Reason] | None:
    """Result code and reason why a trajectory cannot be followed, or None; as strict as ros2_control's."""
    if sorted(names) != sorted(joints):
        return INVALID_JOINTS, OtherJoints(tuple(names), tuple(joints))
    if not points:
        return INVALID_GOAL, TrajectoryEmpty()
    before = -1.0
    for number, point in enumerate(points):
        if len(point.positions) != len(names) or len(point.velocities) not in (0, len(names)):
            return INVALID_GOAL, PointUnfit(number)
        if not all(map(math.isfinite, (*point.positions, *point.velocities))):
            return INVALID_GOAL, PointNotFinite(number)
        if point.time <= before or point.time < 0:
            return INVALID_GOAL, PointTooEarly(number, point.time)
        before = point.time
    return None


class ReferenceTrajectory:
    """Positions over time: cubic between points with velocities, straight between others."""

    def __init__(self, joints: Mapping[str, Joint], start: Knot, names: Sequence[str], points: Sequence[Knot]) -> None:
        """`start` is the arm now, in the order of `joints`; `points` are in the order of `names`."""
        order = [names.index(name) for name in joints]
        turns = self._turns(joints, start, points[0], order)
        sorted_points = [
            Knot(
                p.time,
                tuple(p.positions[i] + turn for i, turn in zip(order, turns, strict=True)),
                tuple(p.velocities[i] for i in order) if p.velocities else (),
            )
            for p in points
        ]
        self._points = sorted_points if points[0].time == 0 else [start, *sorted_points]
        self._times = [p.time for p in self._points]

    @staticmethod
    def _turns(joints: Mapping[str, Joint], start: Knot, first: Knot, order: Sequence[int]) -> list[float]:
        """Whole turns [rad] to add for joints without limits, so that none turns back by whole turns."""
        offsets = []
        for joint, now, i in zip(joints.values(), start.positions, order, strict=True):
            apart = round((now - first.positions[i]) / math.tau) if joint.min is None and joint.max is None else 0
            offsets.append(apart * math.tau)
        return offsets

    @property
    def duration(self) -> float:
        """Time of the last point [s]."""
        return self._times[-1]

    @property
    def end(self) -> tuple[float, ...]:
        """Positions of the last point [rad]."""
        return self._points[-1].positions

    def at(self, time: float) -> tuple[float, ...]:
        """Reference positions [rad]."""
        return tuple(self.joint(i, time) for i in range(len(self.end)))

    def joint(self, number: int, time: float) -> float:
        """Reference position [rad] of one joint, counted in the order of the controller."""
        if time >= self.duration:
            return self.end[number]
        i = max(1, bisect.bisect_right(self._times, time))
        if time <= self._times[0] or i >= len(self._points):
            return self._points[0].positions[number]
        a, b = self._points[i - 1], self._points[i]
        gap = b.time - a.time
        share, p, q = (time - a.time) / gap, a.positions[number], b.positions[number]
        if not (a.velocities and b.velocities):
            return p + (q - p) * share
        return _cubic(share, gap, p, q, a.velocities[number], b.velocities[number])


def _cubic(s: float, gap: float, p: float, q: float, v: float, w: float) -> float:
    """Hermite interpolation at share `s` between positions p, q with velocities v, w."""
    u = 1 - s
    return u * u * (1 + 2 * s) * p + s * s * (3 - 2 * s) * q + gap * s * u * (u * v - s * w)
