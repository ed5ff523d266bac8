"""Whether the machine follows its commands: finds joints that stand still or go the wrong way. Pure logic.

Controllers differ in how far they run behind their reference. So an angle is not compared with the reference of this
moment, but with what the joint must have reached after dead time and lag, and with the reference as a whole.
"""

import bisect
import math
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tms_proof.reasons import OffPath, Stalled
from tms_reason.reason import Reason

QUIET = 0.8  # s for which a joint that is behind must not have moved at all
QUIET_ANGLE = 0.005  # rad that count as no motion
BEHIND = 0.05  # rad
OFF_PATH = 0.2  # rad outside of the range that the reference has passed through
AHEAD = 1.0  # s that a controller may have begun before its acceptance was received here
SMALLEST = 0.0005  # rad of a reference that must show as motion: from stand-still it is faster than the limit by then


@dataclass(frozen=True)
class Way:
    """The reference of one joint: angles [rad] at times [s] from its begin."""

    times: Sequence[float]
    angles: Sequence[float]

    def at(self, time: float) -> float:
        """Angle at a time, straight between the points."""
        i = bisect.bisect_right(self.times, time)
        if i == 0:
            return self.angles[0]
        if i == len(self.times):
            return self.angles[-1]
        share = (time - self.times[i - 1]) / (self.times[i] - self.times[i - 1])  # the search finds no gap of 0 s
        return self.angles[i - 1] + (self.angles[i] - self.angles[i - 1]) * share

    def hull(self, begin: float, end: float) -> tuple[float, float]:
        """Lowest and highest angle from one time to another."""
        passed = [angle for at, angle in zip(self.times, self.angles, strict=True) if begin <= at <= end]
        passed += [self.at(begin), self.at(end)]
        return min(passed), max(passed)


def ways(
    names: Sequence[str], points: Sequence[tuple[float, Sequence[float]]], start: Mapping[str, float]
) -> dict[str, Way]:
    """The reference of each joint that is known; points are times [s] and angles [rad] in the order of `names`.

    The angles of a joint without end stops may be commanded whole turns away from where the joint is.
    """
    found = {}
    for i, name in enumerate(names):
        if name not in start:
            continue
        begin = start[name]
        turns = round((begin - points[0][1][i]) / math.tau) * math.tau
        times = [0.0, *(time for time, _ in points if time > 0)]
        angles = [begin, *(angles[i] + turns for time, angles in points if time > 0)]
        found[name] = Way(times, angles)
    return found


class Follower:
    """Checks the joints while one goal runs; times are monotonic seconds."""

    def __init__(self, found: Mapping[str, Way], reached: float, begun: float, scale: float = 1.0) -> None:
        """`reached`: dead time and lag [s], then a joint is where its reference was; `scale`: speed of a stand-in."""
        self._ways, self._reached, self._begun, self._scale = dict(found), reached, begun, scale
        self._seen: dict[str, deque[tuple[float, float]]] = {name: deque() for name in found}

    def should_have_moved(self, seconds: float) -> bool:
        """Whether the reference has moved within the first `seconds`."""
        passed = seconds * self._scale
        return any(max(map(abs, (high - way.angles[0], low - way.angles[0]))) > SMALLEST
                   for way in self._ways.values() for low, high in [way.hull(0.0, passed)])  # fmt: skip

    def behind(self, over: float, now: float) -> dict[str, tuple[float, float]]:
        """Where each joint began, and how far from there it must be [rad] if what was commanded until `over` has come.

        What was commanded within dead time and lag before `now` may not have come yet.
        """
        passed = (min(over, now - self._reached / self._scale) - self._begun) * self._scale
        return {name: (way.angles[0], abs(way.at(passed) - way.angles[0])) for name, way in self._ways.items()}

    def on_its_way(self, now: float, dead_times: Mapping[str, float], over: float) -> dict[str, float]:
        """How far each joint [rad] must go after a stop: what was commanded within its dead time [s], until `over`.

        Some controllers command each joint at the time of its reference, others delay them so that all follow together.
        """
        longest = max(dead_times.values(), default=0.0)
        found = {}
        for name, way in self._ways.items():
            own = dead_times[name]
            found[name] = min(self._went(way, at, own, over) for at in (now, now - longest + own))
        return found

    def moved(self, now: float, seconds: float) -> bool:
        """Whether the reference has moved within the last seconds, so that what is received must have changed."""
        return any(self._went(way, now, seconds) > BEHIND for way in self._ways.values())

    def _went(self, way: Way, now: float, seconds: float, over: float = math.inf) -> float:
        """How far a reference that ended when it was `over` went within the last seconds [rad]."""
        begin, end = ((at - self._begun) * self._scale for at in (now - seconds, min(now, over)))
        low, high = way.hull(min(begin, end), end)
        return high - low

    def check(self, now: float, angles: Mapping[str, float]) -> Reason | None:
        """What is wrong with where the joints are [rad], None if nothing."""
        for name, way in self._ways.items():
            if name not in angles:
                continue
            wrong = self._stalled(name, way, now, angles[name]) or self._off(name, way, now, angles[name])
            if wrong is not None:
                return wrong
        return None

    def _stalled(self, name: str, way: Way, now: float, angle: float) -> Reason | None:
        seen = self._seen[name]
        seen.append((now, angle))
        while len(seen) > 1 and now - seen[1][0] >= QUIET:
            seen.popleft()
        if now - seen[0][0] < QUIET:
            return None
        passed, past = (now - self._begun) * self._scale, [at for _, at in seen]
        low, high = way.hull(passed - self._reached, passed + AHEAD * self._scale)  # not every controller runs behind
        if low - BEHIND <= angle <= high + BEHIND or max(past) - min(past) > QUIET_ANGLE:
            return None
        due = min(low, high, key=lambda bound: abs(bound - angle))
        return Stalled(name, angle, due)

    def _off(self, name: str, way: Way, now: float, angle: float) -> Reason | None:
        low, high = way.hull(0.0, (now - self._begun + AHEAD) * self._scale)
        if low - OFF_PATH <= angle <= high + OFF_PATH:
            return None
        return OffPath(name, angle, low, high)
