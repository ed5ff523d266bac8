"""The motion that a stand-in reports, and the faults that falsify it. Pure logic."""

import math
from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from tms_config.site_file import Fault
from tms_sim.soil import LEVEL, Stance

SECOND = 1_000_000_000  # ns


class Reading(NamedTuple):
    """The state of a machine at one time: joints in the order of the controller, place and speeds of the base."""

    stamp: int  # ns, utc
    positions: tuple[float, ...]  # rad
    velocities: tuple[float, ...]  # rad/s
    place: tuple[float, float, float]  # x m, y m, yaw rad, in `map`
    speeds: tuple[float, float]  # m/s, rad/s
    stands: Stance = LEVEL

    def each(self, change: Callable[[float], float]) -> "Reading":
        """The same with every number changed; the stamp stays."""
        x, y, yaw = map(change, self.place)
        v, w = map(change, self.speeds)
        joints = tuple(map(change, self.positions)), tuple(map(change, self.velocities))
        return Reading(self.stamp, *joints, (x, y, yaw), (v, w), Stance(*map(change, self.stands)))

    def standing(self) -> "Reading":
        """The same with all velocities 0."""
        return self._replace(velocities=(0.0,) * len(self.velocities), speeds=(0.0, 0.0))

    def displaced(self, way: float) -> "Reading":
        """The same with every position [rad, m] off by `way`; the heading stays."""
        x, y, yaw = self.place
        return self._replace(positions=tuple(q + way for q in self.positions), place=(x + way, y + way, yaw))


class SensorModel:
    """Turns true readings into reported ones."""

    def __init__(self, kept: int) -> None:
        """`kept`: number of readings that the fault `replay` repeats."""
        self._last: deque[Reading] = deque(maxlen=max(1, kept))
        self._frozen: Reading | None = None

    def apply(self, true: Reading, fault: Fault) -> Reading:
        """The reading that is reported instead of the true one."""
        if fault.frozen_stamp:
            if self._frozen is None:
                self._frozen = self._last[-1] if self._last else true
            return self._frozen
        self._frozen = None
        if fault.replay and self._last:
            self._last.rotate(-1)
            reported = self._last[-1]._replace(stamp=true.stamp)
        else:
            reported = true
            self._last.append(true)
        return _lie(reported, fault)


def _lie(reported: Reading, fault: Fault) -> Reading:
    if fault.zero_velocity:
        reported = reported.standing()
    if fault.jump:
        reported = reported.displaced(fault.jump)
    if fault.nan:
        reported = reported.each(lambda _: math.nan)
    if fault.back_in_time:
        reported = reported._replace(stamp=reported.stamp - int(fault.back_in_time * SECOND))
    return reported
