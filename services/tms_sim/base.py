"""Drives tracks along poses on flat ground. Pure logic, all in the frame `map`."""

import itertools
import math
from collections.abc import Sequence
from typing import NamedTuple

from tms_config.models import Drive, Response
from tms_sim.tracks import SUBSTEP, Tracks, cut

THERE = 0.05  # m
ALIGNED = 0.01  # rad
PASSED = 0.5  # m, within which a pose that is only passed counts as reached
STEERS = 0.35  # rad off the direction, beyond which the machine turns on the spot
GENTLE = 0.8  # share of the acceleration that braking for a goal uses
STOPPED = 1e-3  # m/s


class Leg(NamedTuple):
    """A place to drive to [m] and the heading there [rad]; a place without yaw is only passed."""

    x: float
    y: float
    yaw: float | None


class Base(Tracks):
    """The tracks and their navigation."""

    def __init__(self, drive: Drive, start: tuple[float, float, float], response: Response | None = None) -> None:
        super().__init__(drive, start, response)
        self.fastest = drive.velocity  # m/s of a way
        self.stuck = False  # the tracks do not move, whatever is commanded
        self.legs: list[Leg] = []
        self._aligning = False
        self._owed = 0.0  # s not yet stepped

    def command(self, v: float, w: float) -> None:
        """Take velocities that stay until the next command, as in the simulator; a way has priority."""
        if math.isfinite(v) and math.isfinite(w) and not self.legs:
            self.send(cut(v, self.drive.velocity), cut(w, self.drive.turn_velocity))

    def limit(self, speed: float) -> None:
        """Keep ways to a speed [m/s]; turns are slowed by the same share."""
        self.fastest = min(speed, self.drive.velocity)

    def go(self, legs: Sequence[Leg]) -> None:
        """Begin a way from the present place of the machine."""
        self.legs, self._aligning = list(legs), False

    def hold(self) -> None:
        """Give up way and velocities, and brake."""
        self.go(())
        self.send(0.0, 0.0)

    def halt(self, immediately: bool) -> None:
        """Do the emergency stop, with or without the dead time."""
        self.hold()
        if immediately:
            self.brake_at_once()

    def left(self) -> float:
        """Distance to go [m], straight from pose to pose."""
        places = [(self.x, self.y), *((leg.x, leg.y) for leg in self.legs)]
        return math.fsum(math.dist(a, b) for a, b in itertools.pairwise(places))  # 0.0, not 0, for ROS

    def step(self, seconds: float) -> None:
        """Let time pass."""
        self._owed += seconds
        count = int(self._owed / SUBSTEP + 1e-6)
        self._owed -= count * SUBSTEP
        if self.stuck:
            self.v = self.w = 0.0
            self.brake_at_once()
        if self.stuck or (self.still and not self.legs and not self.leak):
            self.now += count * SUBSTEP
            return
        for _ in range(count):
            self._substep(SUBSTEP)

    def _substep(self, h: float) -> None:
        if self.legs:
            self.lead(*self._wanted(), h)
            if not self.legs:
                self.send(0.0, 0.0)
        self.move(h)

    def _wanted(self) -> tuple[float, float]:
        """Velocities for the first leg; removes the leg from the way when it is done."""
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
        v = min(self.fastest, slow) * math.cos(off) if abs(off) < STEERS else 0.0
        return v, self._turning(off)

    def _align(self, leg: Leg) -> float:
        off = 0.0 if leg.yaw is None else math.remainder(leg.yaw - self.yaw, math.tau)
        if abs(off) <= ALIGNED and abs(self.v) < STOPPED and abs(self.w) < ALIGNED:
            self.legs.pop(0)
            self._aligning = False
            return 0.0
        return self._turning(off)

    def _turning(self, off: float) -> float:
        turning = self.drive.turn_velocity * self.fastest / self.drive.velocity
        most = min(turning, _braking(abs(off), self.drive.turn_acceleration))
        return math.copysign(most, off)


def _braking(way: float, acceleration: float) -> float:
    """The velocity from which braking takes `way`."""
    return math.sqrt(2 * GENTLE * acceleration * way)
