"""Goals of the navigation: one at a time, a newer one preempts, and no progress is a failure, as Nav2 has it."""

import math
import threading
from collections.abc import Sequence
from dataclasses import dataclass, field

from tms_sim.base import Base, Leg
from tms_sim.motion import ABORTED, CANCELED, SUCCEEDED, Motion, Verdict

PROGRESS, PATIENCE = 0.5, 10.0  # m in s: the machines' progress checker
TURNED = 0.3  # rad that count as progress, too
FAILED = 1  # error code of the navigation
MISSED = 601  # error code of a waypoint that was not reached


@dataclass
class Trip(Motion):
    """One goal: places one after another. A trip whose legs are waypoints goes on when one cannot be reached."""

    legs: Sequence[Leg]
    waypoints: bool = False
    seconds: float = 0.0  # on the way so far
    missed: list[int] = field(default_factory=list)
    braking: Verdict | None = None  # verdict once the machine stands
    mark: tuple[float, float, float, float] = (math.inf, 0.0, 0.0, 0.0)  # x, y, yaw at a time: the last progress


class Travel:
    """Trips in, motion of the base out."""

    def __init__(self, base: Base) -> None:
        self.base = base
        self.emergency = False
        self._trip: Trip | None = None
        self._lock = threading.Lock()

    @property
    def busy(self) -> bool:
        """Whether a goal is open."""
        return self._trip is not None

    def refusal(self, legs: Sequence[Leg]) -> str | None:
        """Why a goal is not taken, or None."""
        if self.emergency:
            return "the emergency stop is on: publish false on emg_stop to release it"
        if not all(math.isfinite(number) for leg in legs for number in leg if number is not None):
            return "a pose holds a value that is not a number"
        return None

    def begin(self, legs: Sequence[Leg], *, waypoints: bool = False, miss: Sequence[int] = ()) -> Trip:
        """Set out; waypoints in `miss` cannot be reached."""
        with self._lock:
            if self._trip is not None:
                self._trip.end(Verdict(ABORTED, FAILED, "preempted by a newer goal"))
            trip = Trip(legs, waypoints)
            trip.missed = [i for i in miss if i < len(legs)]
            self._trip = trip
            if not legs:
                trip.braking = Verdict(ABORTED, FAILED, "there is no pose in the goal")
            elif self.emergency:
                trip.braking = Verdict(ABORTED, FAILED, "emergency stop")
            else:
                self.base.go([leg for i, leg in enumerate(legs) if i not in trip.missed])
            return trip

    def cancel(self, trip: Trip) -> None:
        """Brake; the goal ends CANCELED once the machine stands."""
        with self._lock:
            if trip is self._trip:
                self._brake(Verdict(CANCELED, text="stopped on request"))

    def stop(self, on: bool) -> None:
        """Level of the emergency stop."""
        with self._lock:
            self.emergency = on
            if on:
                self._brake(Verdict(ABORTED, FAILED, "emergency stop"))

    def current(self, trip: Trip) -> int:
        """Number of the waypoint that is driven to."""
        reachable = [i for i in range(len(trip.legs)) if i not in trip.missed]
        left = len(self.base.legs)
        return reachable[-left] if 0 < left <= len(reachable) else max(0, len(trip.legs) - 1)

    def _brake(self, verdict: Verdict) -> None:
        self.base.hold()
        if self._trip is not None and self._trip.braking is None:
            self._trip.braking = verdict

    def step(self, seconds: float) -> None:
        """Let time pass and end what is due."""
        with self._lock:
            self.base.step(seconds)
            trip = self._trip
            if trip is None:
                return
            trip.seconds += seconds
            if trip.braking is None and not self._progress(trip):
                self._brake(Verdict(ABORTED, FAILED, f"no progress for {PATIENCE:.0f} s"))
            if self.base.still and (trip.braking is not None or not self.base.legs):
                self._trip = None
                trip.end(trip.braking or _arrived(trip))

    def _progress(self, trip: Trip) -> bool:
        base, (x, y, yaw, since) = self.base, trip.mark
        moved = math.hypot(base.x - x, base.y - y) >= PROGRESS
        if moved or abs(math.remainder(base.yaw - yaw, math.tau)) >= TURNED:
            trip.mark = (base.x, base.y, base.yaw, trip.seconds)
            return True
        return trip.seconds - since < PATIENCE


def _arrived(trip: Trip) -> Verdict:
    """Nav2 calls a path with missed waypoints a success unless it is told otherwise; so does its stand-in."""
    return Verdict(SUCCEEDED)
