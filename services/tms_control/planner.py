"""Plans paths of tracks between poses: of all candidates, the one that takes least time.

Candidates are turn on the spot, line, turn; and arc, line, arc (the words of L. E. Dubins, 1957); each of them forward
and in reverse. Reverse is slower, so that only a short way is taken so. Obstacles do not count here (see detour.py).
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from typing import NamedTuple

from tms_config.models import Drive
from tms_control.path import SAME_HEADING, SAME_PLACE, Path, Piece, Pose

RADIUS = 3.8  # m, of arcs: where the path follower of the real mst110cr begins to slow down for a curve
REVERSE = 0.5  # times the speed forward: ours, the operator sees less there
STOP = 3.0  # s that a turn on the spot costs besides its angle: to stand, to begin, to settle


class Goal(NamedTuple):
    """A place to drive to [m] and the heading there [rad]; a place without heading is only passed."""

    x: float
    y: float
    yaw: float | None


@dataclass(frozen=True)
class Pace:
    """What a plan reckons with."""

    forward: float  # m/s
    turn: float  # rad/s

    @classmethod
    def of(cls, drive: Drive, yaw_gain: float) -> "Pace":
        """What tracks do whose yaw rate is a part of the commanded one."""
        return cls(drive.velocity, drive.turn_velocity * yaw_gain)

    def seconds(self, piece: Piece) -> float:
        """How long a piece takes."""
        turning = abs(piece.turn) / self.turn
        if not piece.length:
            return STOP + turning
        return max(piece.length / self.speed(piece.direction), turning)

    def speed(self, direction: int) -> float:
        """Speed on a line [m/s]."""
        return self.forward * (1.0 if direction > 0 else REVERSE)

    def total(self, pieces: Sequence[Piece]) -> float:
        """How long they take, one after the other [s]."""
        changes = sum(a.length > 0 < b.length and a.direction != b.direction for a, b in pairwise(pieces))
        return math.fsum(map(self.seconds, pieces)) + STOP * changes


@dataclass(frozen=True)
class Plan:
    """A path through goals, and how far along it each of them is reached."""

    path: Path
    reached: tuple[int, ...]  # number of pieces, after which each goal is reached


def plan(start: Pose, goals: Sequence[Goal], pace: Pace, pivot: float = 0.0) -> Plan:
    """The fastest path from a pose through goals, the last of which has a heading.

    The path is that of the pivot, the place `pivot` [m] ahead that a turn on the spot does not move. For a goal that is
    only passed, a few headings are tried: those of the ways there and on, and between both.
    """
    best: dict[Pose, list[list[Piece]]] = {start.ahead(pivot): []}
    for number, goal in enumerate(goals):
        before = goals[number - 1] if number else start
        onward = goals[number + 1] if number + 1 < len(goals) else None
        reached: dict[Pose, list[list[Piece]]] = {}
        for pose in (one.ahead(pivot) for one in passable(before, goal, onward)):
            ways = ([*legs, fastest(begin, pose, pace)] for begin, legs in best.items())
            reached[pose] = min(ways, key=lambda legs: pace.total([piece for leg in legs for piece in leg]))
        best = reached
    legs = min(best.values(), key=lambda legs: pace.total([piece for leg in legs for piece in leg]))
    pieces = [piece for leg in legs for piece in leg]
    counts = tuple(sum(map(len, legs[: i + 1])) for i in range(len(legs)))
    return Plan(Path(tuple(pieces) or (Piece(start.ahead(pivot), 0.0, 0.0),)), counts)


def passable(before: Goal | Pose, goal: Goal, onward: Goal | None) -> list[Pose]:
    """The poses in which a goal may be reached."""
    if goal.yaw is not None or onward is None:
        return [Pose(goal.x, goal.y, goal.yaw or 0.0)]
    there = math.atan2(goal.y - before.y, goal.x - before.x)
    on = math.atan2(onward.y - goal.y, onward.x - goal.x)
    between = there + math.remainder(on - there, math.tau) / 2
    return [Pose(goal.x, goal.y, yaw + turned) for yaw in (there, between, on) for turned in (0.0, math.pi)]


def fastest(start: Pose, goal: Pose, pace: Pace) -> list[Piece]:
    """The pieces between two poses that take least time; none if they are the same."""
    return min(words(start, goal), key=pace.total)


def words(start: Pose, goal: Pose) -> list[list[Piece]]:
    """All candidates between two poses."""
    return [_without_nothing(pieces) for pieces in _candidates(start, goal)]


def _candidates(start: Pose, goal: Pose) -> Iterator[list[Piece]]:
    if start.away(goal) <= SAME_PLACE:
        yield [Piece(start, 0.0, start.off(goal.yaw))]
        return
    for direction in (1, -1):
        yield _line(start, goal, direction)
        for first, last in product((1, -1), (1, -1)):
            yield from _arcs(start, goal, direction, first, last)


def _without_nothing(pieces: Sequence[Piece]) -> list[Piece]:
    return [piece for piece in pieces if piece.length > SAME_PLACE or abs(piece.turn) > SAME_HEADING]


def _line(start: Pose, goal: Pose, direction: int) -> list[Piece]:
    """Turn, line, turn."""
    bearing = math.atan2(goal.y - start.y, goal.x - start.x) + (0.0 if direction > 0 else math.pi)
    turn = Piece(start, 0.0, start.off(bearing))
    line = Piece(turn.end, start.away(goal), 0.0, direction)
    arrived = Pose(goal.x, goal.y, line.end.yaw)
    return [turn, line, Piece(arrived, 0.0, arrived.off(goal.yaw))]


def _arcs(start: Pose, goal: Pose, direction: int, first: int, last: int) -> Iterator[list[Piece]]:
    """Arc, line, arc; `first` and `last` are 1 where the heading turns to the left, else -1; none if they do not fit.

    The circles of both arcs have a common tangent: between circles of the same sense it is parallel to the line
    between their centres, else it crosses that line.
    """
    back = 0.0 if direction > 0 else math.pi  # in reverse it moves as a machine that looks the other way
    a, b = _centre(start, first, back), _centre(goal, last, back)
    apart = math.dist(a, b)
    across = 0.0 if first == last else 2 * RADIUS
    if apart < across:
        return
    length = math.sqrt(apart**2 - across**2)
    along = math.atan2(b[1] - a[1], b[0] - a[0]) + first * math.atan2(across, length) - back
    one = first * (first * (along - start.yaw) % math.tau)
    two = last * (last * (goal.yaw - along) % math.tau)
    arc = Piece(start, RADIUS * abs(one), one, direction)
    line = Piece(arc.end, length, 0.0, direction)
    yield [arc, line, Piece(line.end, RADIUS * abs(two), two, direction)]


def _centre(pose: Pose, sense: int, back: float) -> tuple[float, float]:
    """Centre of the circle that it moves on."""
    yaw = pose.yaw + back
    return pose.x - sense * RADIUS * math.sin(yaw), pose.y + sense * RADIUS * math.cos(yaw)
