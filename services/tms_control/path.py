"""Paths of tracks on flat ground: lines, arcs and turns on the spot, forward or in reverse.

Frame `map`; m and rad. A heading is that of the machine, also in reverse. Headings of pieces are not limited to one
turn, so that an arc of more than half a turn has one meaning.
"""

import math
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate, groupby, pairwise
from typing import NamedTuple

SAME_PLACE = 1e-3  # m
SAME_HEADING = 1e-3  # rad
ALONG = 0.3  # rad that a heading may differ from the way before a told path is read as one whose headings say nothing


class Pose(NamedTuple):
    """A place [m] and a heading [rad]."""

    x: float
    y: float
    yaw: float

    def away(self, other: "Pose") -> float:
        """Distance between the places [m]."""
        return math.hypot(other.x - self.x, other.y - self.y)

    def off(self, yaw: float) -> float:
        """How far to turn to a heading the short way, in [-pi, pi]."""
        return math.remainder(yaw - self.yaw, math.tau)

    def ahead(self, way: float) -> "Pose":
        """The place some metres ahead, with the same heading."""
        return Pose(self.x + way * math.cos(self.yaw), self.y + way * math.sin(self.yaw), self.yaw)

    def seen(self, other: "Pose") -> tuple[float, float]:
        """Where another place is from here: forward and to the left [m]."""
        dx, dy = other.x - self.x, other.y - self.y
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return c * dx + s * dy, c * dy - s * dx


@dataclass(frozen=True)
class Piece:
    """A line, an arc, or a turn on the spot (length 0)."""

    start: Pose
    length: float  # m, not negative
    turn: float  # rad, change of the heading
    direction: int = 1  # 1 forward, -1 in reverse

    @property
    def curvature(self) -> float:
        """Change of the heading a metre [rad/m]; 0 for a turn on the spot."""
        return self.turn / self.length if self.length else 0.0

    @property
    def end(self) -> Pose:
        """Where it ends."""
        if not self.length:
            return self.start._replace(yaw=self.start.yaw + self.turn)
        return self.at(self.length)

    def at(self, way: float) -> Pose:
        """The pose after some metres of a line or an arc; beyond the ends, it goes on as it is."""
        x, y, yaw = self.start
        k, signed = self.curvature, self.direction * way
        half = k * way / 2  # a chord of an arc points to the middle of both headings
        chord = signed * (math.sin(half) / half if abs(half) > 1e-9 else 1.0)
        return Pose(x + chord * math.cos(yaw + half), y + chord * math.sin(yaw + half), yaw + k * way)


@dataclass(frozen=True)
class Run:
    """Pieces that are driven without a stop, all in one direction."""

    pieces: tuple[Piece, ...]

    @property
    def direction(self) -> int:
        """1 forward, -1 in reverse."""
        return self.pieces[0].direction

    @cached_property
    def starts(self) -> tuple[float, ...]:
        """How far from the begin each piece begins [m], and where the last one ends."""
        return tuple(accumulate((piece.length for piece in self.pieces), initial=0.0))

    @property
    def length(self) -> float:
        """Length [m]."""
        return self.starts[-1]

    def cut(self, begin: float, end: float) -> list[Piece]:
        """Its pieces between two ways from the begin [m]."""
        found = []
        for piece, start in zip(self.pieces, self.starts, strict=False):
            first, last = max(begin - start, 0.0), min(end - start, piece.length)
            if first < last:
                part = (last - first) / piece.length
                found.append(Piece(piece.at(first), last - first, piece.turn * part, piece.direction))
        return found

    def at(self, way: float) -> Pose:
        """The pose after some metres; beyond the end, straight on."""
        if way >= self.length:
            return Piece(self.pieces[-1].end, 1.0, 0.0, self.direction).at(way - self.length)
        number = bisect_right(self.starts, max(way, 0.0)) - 1
        return self.pieces[number].at(way - self.starts[number])

    def project(self, place: Pose, near: float) -> float:
        """How far along [m] the place nearest to another one is, looked for from a guess; may be beyond the end."""
        way = near
        for _ in range(5):
            way += self.direction * self.at(way).seen(place)[0]
        return way


Part = Run | Piece  # a piece by itself is a turn on the spot


@dataclass(frozen=True)
class Path:
    """Pieces, each beginning where the last one has ended."""

    pieces: tuple[Piece, ...]

    @property
    def length(self) -> float:
        """Length [m]."""
        return math.fsum(piece.length for piece in self.pieces)

    @property
    def end(self) -> Pose:
        """Where it ends."""
        return self.pieces[-1].end

    def parts(self) -> tuple[Part, ...]:
        """What is driven without a stop, and turns on the spot."""
        found: list[Part] = []
        for direction, pieces in groupby(self.pieces, lambda piece: piece.direction if piece.length else 0):
            same = tuple(pieces)
            found += [Run(same)] if direction else same
        return tuple(found)

    def poses(self, step: float) -> Iterator[Pose]:
        """Poses along it, at most `step` [m] apart, with begin and end of each piece."""
        yield self.pieces[0].start
        for piece in self.pieces:
            count = max(1, math.ceil(piece.length / step))
            for i in range(1, count):
                yield piece.at(piece.length * i / count)
            yield piece.end


def told(poses: Sequence[Pose]) -> Path:
    """The path through poses that somebody else has planned, close together, with the headings there.

    Between poses whose headings say something lies an arc, forward or in reverse. Planners that know no headings tell
    the same one for all poses: then the way is straight and forward from place to place.
    """
    pieces: list[Piece] = []
    for a, b in pairwise(poses):
        if a.away(b) > SAME_PLACE:
            pieces.append(_between(a, b))
    joined: list[Piece] = []
    for piece in pieces:
        if joined:
            joined += _turned(joined[-1].end, piece.start.yaw)
        else:
            joined += _turned(poses[0], piece.start.yaw)
        joined.append(piece)
    last = joined[-1].end if joined else poses[0]
    return Path((*joined, *_turned(last, poses[-1].yaw)) or (Piece(last, 0.0, 0.0),))


def _turned(here: Pose, yaw: float) -> list[Piece]:
    """The turn on the spot to a heading; none for a small one, which the next metres heal."""
    off = here.off(yaw)
    return [Piece(here, 0.0, off)] if abs(off) > ALONG else []


def _between(a: Pose, b: Pose) -> Piece:
    """The arc between two poses, or the line between their places if no arc fits."""
    chord, bearing, turn = a.away(b), math.atan2(b.y - a.y, b.x - a.x), a.off(b.yaw)
    middle = Pose(a.x, a.y, a.yaw + turn / 2)
    for direction, heading in ((1, bearing), (-1, bearing + math.pi)):
        if abs(middle.off(heading)) <= ALONG:
            length = chord * (turn / 2) / math.sin(turn / 2) if abs(turn) > SAME_HEADING else chord
            return Piece(Pose(a.x, a.y, heading - turn / 2), length, turn, direction)
    return Piece(Pose(a.x, a.y, bearing), chord, 0.0)
