"""Tracks on flat ground: velocities with limits, and a way along poses. Pure logic, all in the frame `map`."""

import itertools
import math
from collections.abc import Sequence
from typing import NamedTuple

from tms_core.models import Drive

SUBSTEP = 0.02  # s, at most
THERE = 0.05  # m
ALIGNED = 0.01  # rad
PASSED = 0.5  # m, a pose that is only passed counts from here
STEERS = 0.35  # rad, beyond it the machine turns on the spot
GENTLE = 0.8  # share of the acceleration that braking for a goal uses


class Leg(NamedTuple):
    """A place to go [m] and how to stand there [rad]; without yaw it is only passed."""

    x: float
    y: float
    yaw: float | None


class Base:
    """Position [m], heading [rad] and velocities [m/s, rad/s] of a machine."""

    def __init__(self, drive: Drive, start: tuple[float, float, float]) -> None:
        self.drive = drive
        self.x, self.y, self.yaw = start
        self.v = self.w = 0.0
        self.stuck = False  # nothing moves, whatever is asked
        self.legs: list[Leg] = []
        self._aligning = False
        self._twist = (0.0, 0.0)

    @property
    def still(self) -> bool:
        """Whether nothing moves."""
        return self.v == 0.0 and self.w == 0.0

    def command(self, v: float, w: float) -> None:
        """Velocities that hold until the next command, as the simulator's tracks have them; a way goes first."""
        if math.isfinite(v) and math.isfinite(w):
            most = self.drive
            self._twist = (_cut(v, most.velocity), _cut(w, most.turn_velocity))

    def go(self, legs: Sequence[Leg]) -> None:
        """Begin a way from wherever the machine is."""
        self.legs, self._aligning, self._twist = list(legs), False, (0.0, 0.0)

    def hold(self) -> None:
        """Give up way and velocities, and brake."""
        self.go(())

    def left(self) -> float:
        """Distance to go [m], straight from pose to pose."""
        places = [(self.x, self.y), *((leg.x, leg.y) for leg in self.legs)]
        return math.fsum(math.dist(a, b) for a, b in itertools.pairwise(places))  # 0.0, not 0, for ROS

    def step(self, seconds: float) -> None:
        """Let time pass."""
        if self.stuck:
            self.v = self.w = 0.0
            return
        count = max(1, math.ceil(seconds / SUBSTEP - 1e-9))
        for _ in range(count):
            if self.still and not self.legs and self._twist == (0.0, 0.0):
                return
            self._substep(seconds / count)

    def _substep(self, h: float) -> None:
        v, w = self._wanted() if self.legs else self._twist
        self.v = _towards(self.v, v, self.drive.acceleration * h)
        self.w = _towards(self.w, w, self.drive.turn_acceleration * h)
        self.yaw = math.remainder(self.yaw + self.w * h, math.tau)
        self.x += self.v * math.cos(self.yaw) * h
        self.y += self.v * math.sin(self.yaw) * h

    def _wanted(self) -> tuple[float, float]:
        """Velocities for the first leg; takes it off the way when it is done."""
        leg, last = self.legs[0], len(self.legs) == 1
        away = math.hypot(leg.x - self.x, leg.y - self.y)
        if leg.yaw is None and not last and away <= PASSED:
            self.legs.pop(0)
            return self.v, self.w
        if away <= THERE:
            self._aligning = True
        if self._aligning:
            return 0.0, self._align(leg)
        off = math.remainder(math.atan2(leg.y - self.y, leg.x - self.x) - self.yaw, math.tau)
        slow = _braking(away, self.drive.acceleration) if last or leg.yaw is not None else math.inf
        v = min(self.drive.velocity, slow) * math.cos(off) if abs(off) < STEERS else 0.0
        return v, self._turning(off)

    def _align(self, leg: Leg) -> float:
        off = 0.0 if leg.yaw is None else math.remainder(leg.yaw - self.yaw, math.tau)
        if abs(off) <= ALIGNED and self.v == 0.0 and abs(self.w) < ALIGNED:
            self.legs.pop(0)
            self._aligning = False
            return 0.0
        return self._turning(off)

    def _turning(self, off: float) -> float:
        most = min(self.drive.turn_velocity, _braking(abs(off), self.drive.turn_acceleration))
        return math.copysign(most, off)


def _braking(way: float, acceleration: float) -> float:
    """The velocity from which braking takes `way`."""
    return math.sqrt(2 * GENTLE * acceleration * way)


def _towards(now: float, wanted: float, most: float) -> float:
    return now + _cut(wanted - now, most)


def _cut(value: float, most: float) -> float:
    return max(-most, min(most, value))
