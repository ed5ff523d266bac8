"""Follows a path: regulated pure pursuit along runs, and turns on the spot in between. Pure logic.

Pure pursuit after R. C. Coulter (1992): the machine is always on the arc to a place of the path some metres ahead. It
is regulated as in Nav2: slower in curves and towards the end. Figures: the path follower of the real mst110cr.
"""

import math
from dataclasses import dataclass

from tms_config.models import Drive
from tms_control.path import Part, Path, Piece, Run
from tms_control.planner import RADIUS, REVERSE
from tms_control.track_estimate import ZERO, Command, TrackState
from tms_control.track_servo import TrackServo

LOOK_AHEAD, NEAREST, FARTHEST = 2.2, 2.0, 3.0  # s, m, m
APPROACH, APPROACH_SPEED = 3.5, 0.25  # m before the end where it begins to slow down, m/s at the end
SLOWEST = 0.05  # m/s, in curves
GENTLE = 0.6  # share of the acceleration that braking for an end or a curve uses
SPARE = 0.8  # share of the yaw rate that a curve may use; the rest is for corrections
LATE = 0.08  # s until brakes act
LOOKS = 0.5  # s between two looks at what stands around, and the age of what they see
ALIGNED = 0.02  # rad, where a turn on the spot ends
HOLD, HOLD_SPEED = 0.4, 0.1  # 1/s, m/s: a turn on the spot keeps its place along the heading


@dataclass(frozen=True)
class Deviation:
    """How far a machine is off its path."""

    beside: float  # m
    turned: float  # rad


class Pursuit:
    """One path. It stands after each part."""

    def __init__(self, path: Path, drive: Drive, servo: TrackServo) -> None:
        self._parts, self._drive, self._servo = path.parts(), drive, servo
        self._pieces_done = 0
        self._way = 0.0  # m along the present run
        self._braking = False  # the present part is done as soon as it stands

    @property
    def done(self) -> bool:
        """Whether it stands at the end of the path."""
        return not self._parts

    @property
    def left(self) -> float:
        """How far it is to the end [m]."""
        runs = [part.length for part in self._parts]
        return max(math.fsum(runs) - self._way, 0.0)

    @property
    def pieces_done(self) -> int:
        """How many pieces of the path are behind."""
        part = self._parts[0] if self._parts else None
        inside = sum(end <= self._way for end in part.starts[1:]) if isinstance(part, Run) else 0
        return self._pieces_done + inside

    def deviation(self, state: TrackState) -> Deviation:
        """How far off the path it is: none in a turn on the spot, which ends wherever it began."""
        part = self._parts[0] if self._parts else None
        if not isinstance(part, Run):
            return Deviation(0.0, 0.0)
        on = part.at(self._way)
        return Deviation(abs(on.seen(state.pose)[1]), abs(on.off(state.pose.yaw)))

    def coming(self, state: TrackState, lag: float) -> list[Piece]:
        """What of the present part it drives through before it can stand; of a turn on the spot, all that is left."""
        part = self._parts[0] if self._parts else None
        if part is None:
            return []
        if isinstance(part, Piece):
            return [Piece(part.start._replace(yaw=state.pose.yaw), 0.0, state.pose.off(part.end.yaw))]
        v = abs(state.v)
        return part.cut(self._way, self._way + v * (lag + LOOKS) + v**2 / (2 * GENTLE * self._drive.acceleration))

    def step(self, state: TrackState) -> Command:
        """The next command."""
        if not self._parts:
            return ZERO
        part = self._parts[0]
        if self._braking:
            if state.stands:
                self._next(part)
            return ZERO
        return self._turn(part, state) if isinstance(part, Piece) else self._drive_along(part, state)

    def _next(self, part: Part) -> None:
        self._parts = self._parts[1:]
        self._pieces_done += 1 if isinstance(part, Piece) else len(part.pieces)
        self._way, self._braking = 0.0, False

    def _turn(self, piece: Piece, state: TrackState) -> Command:
        off = state.pose.off(piece.end.yaw)
        comes_to = off - state.r * LATE
        if abs(comes_to) <= ALIGNED:
            self._braking = True
            return ZERO
        braking = math.sqrt(2 * GENTLE * self._drive.turn_acceleration * abs(off))
        r = math.copysign(min(SPARE * self._servo.fastest_turn, braking), off)
        back = HOLD * state.pose.seen(piece.start)[0]
        return self._servo.lead(state, max(-HOLD_SPEED, min(HOLD_SPEED, back)), r)

    def _drive_along(self, run: Run, state: TrackState) -> Command:
        self._way = run.project(state.pose, self._way)
        left = run.length - self._way
        if left <= abs(state.v) * LATE:
            self._braking = True
            return ZERO
        curvature = self._curvature(run, state)
        v = run.direction * min(self._speed(run, left), self._in_curve(curvature), self._servo.fastest)
        return self._servo.lead(state, v, abs(v) * curvature)

    def _curvature(self, run: Run, state: TrackState) -> float:
        """Change of the heading a metre of way [rad/m] on the arc to the place ahead."""
        reach = min(max(LOOK_AHEAD * abs(state.v), NEAREST), FARTHEST)
        ahead, left = state.pose.seen(run.at(self._way + reach))
        return run.direction * 2 * left / (ahead**2 + left**2)

    def _speed(self, run: Run, left: float) -> float:
        """The speed that approach and the curves ahead allow [m/s]."""
        fastest = self._drive.velocity * (1.0 if run.direction > 0 else REVERSE)
        v = min(fastest, max(APPROACH_SPEED, self._drive.velocity * left / APPROACH))
        for piece, start in zip(run.pieces, run.starts, strict=False):
            if start + piece.length > self._way:
                room = max(start - self._way, 0.0)
                v = min(
                    v,
                    math.hypot(
                        self._in_curve(piece.curvature), math.sqrt(2 * GENTLE * self._drive.acceleration * room)
                    ),
                )
        return v

    def _in_curve(self, curvature: float) -> float:
        """The speed that a curve allows [m/s]: in a tight one, and as far as the tracks can turn."""
        if not curvature:
            return self._drive.velocity
        regulated = self._drive.velocity * min(1.0, 1.0 / (RADIUS * abs(curvature)))
        return max(SLOWEST, min(regulated, SPARE * self._servo.fastest_turn / abs(curvature)))
