"""Goals of the navigation as in Nav2: one at a time, a newer one preempts, and a lack of progress is a failure."""

import math
import threading
from collections.abc import Sequence
from dataclasses import dataclass, field

from tms_sim.base import Base, Leg
from tms_sim.motion import ABORTED, CANCELED, SUCCEEDED, Motion, MotionVerdict

PROGRESS, PATIENCE = 0.5, 10.0  # m within s: figures of the machines' progress checker
TURNED = 0.3  # rad, a turn that counts as progress, too
FAILED = 1  # error code of the navigation


@dataclass
class Trip(Motion):
    """One goal of several places. A trip of waypoints goes on when one of them cannot be reached."""

    legs: Sequence[Leg]
    waypoints: bool = False
    seconds: float = 0.0  # on the way so far
    missed: list[int] = field(default_factory=list)
    braking: MotionVerdict | None = None  # verdict when the machine stands
    mark: tuple[float, float, float, float] = (math.inf, 0.0, 0.0, 0.0)  # x, y, yaw and time of the last progress


class Navigator:
    """Turns trips into motion of the base."""

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
        """Why a goal is refused, or None."""
        if self.emergency:
            return "the emergency stop is on: publish false on emg_stop to release it"
        if not all(math.isfinite(number) for leg in legs for number in leg if number is not None):
            return "a pose holds a value that is not a number"
        return None

    def begin(self, legs: Sequence[Leg], *, waypoints: bool = False, miss: Sequence[int] = ()) -> Trip:
        """Begin a trip; the waypoints in `miss` cannot be reached."""
        with self._lock:
            if self._trip is not None:
                self._trip.end(MotionVerdict(ABORTED, FAILED, "preempted by a newer goal"))
            trip = Trip(legs, waypoints)
            trip.missed = [i for i in miss if i < len(legs)]
            self._trip = trip
            if not legs:
                trip.braking = MotionVerdict(ABORTED, FAILED, "there is no pose in the goal")
            elif self.emergency:
                trip.braking = MotionVerdict(ABORTED, FAILED, "emergency stop")
            else:
                self.base.go([leg for i, leg in enumerate(legs) if i not in trip.missed])
            return trip

    def cancel(self, trip: Trip) -> None:
        """Brake; the goal ends CANCELED once the machine stands."""
        with self._lock:
            if trip is self._trip:
                self._brake(MotionVerdict(CANCELED, text="stopped on request"))

    def stop(self, on: bool) -> None:
        """Set the level of the emergency stop."""
        with self._lock:
            self.emergency = on
            if on:
                self._brake(MotionVerdict(ABORTED, FAILED, "emergency stop"))

    def current(self, trip: Trip) -> int:
        """Number of the waypoint that is driven to."""
        reachable = [i for i in range(len(trip.legs)) if i not in trip.missed]
        left = len(self.base.legs)
        return reachable[-left] if 0 < left <= len(reachable) else max(0, len(trip.legs) - 1)

    def _brake(self, verdict: MotionVerdict) -> None:
        self.base.hold()
        if self._trip is not None and self._trip.braking is None:
            self._trip.braking = verdict

    def step(self, seconds: float) -> None:
        """Let time pass, and end the trip when it is due."""
        with self._lock:
            self.base.step(seconds)
            trip = self._trip
            if trip is None:
                return
            trip.seconds += seconds
            if trip.braking is None and not self._progress(trip):
                self._brake(MotionVerdict(ABORTED, FAILED, f"no progress for {PATIENCE:.0f} s"))
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


def _arrived(trip: Trip) -> MotionVerdict:
    """The verdict at the end: like Nav2 by default, a path with missed waypoints is a success."""
    return MotionVerdict(SUCCEEDED)
