"""Roads of a site: lines that a machine on tracks follows where that is not much longer than straight across.

A metre beside roads counts as three on one. So a way begins and ends off the road where that is needed, changes from
one road to another where they meet or come near, and leaves roads alone that lead elsewhere. Both directions are the
same. Frame `map`, m.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from tms_control.ground import Array
from tms_control.path import Pose
from tms_control.planner import RADIUS, Goal

OFF_ROAD = 3.0  # m on a road that count as one beside it
STEP = 5.0  # m between the places of a road where it may be entered or left
ASIDE = 0.3  # m that a way may be off the line of a road where places of it are left out
MOST = 1000  # places of all roads together: half a second for the first way on a busy PC

Place = tuple[float, float]


@dataclass(frozen=True)
class Roads:
    """All roads of a site: the places of each in turn, 2 at least."""

    lines: tuple[tuple[Place, ...], ...] = ()

    def between(self, start: Pose, goal: Pose) -> tuple[Goal, ...]:
        """The places to pass on the way from one pose to another; none where roads do not help."""
        if not self.lines:
            return ()
        places = np.concatenate([[start[:2], goal[:2]], self._places])
        costs = np.full((len(places), len(places)), np.inf)
        costs[2:, 2:] = self._costs
        for end in (0, 1):
            costs[end] = costs[:, end] = OFF_ROAD * np.hypot(*(places - places[end]).T)
        way = places[_shortest(costs)]
        apart = [place for place in way[1:-1] if min(math.dist(place, end[:2]) for end in (start, goal)) >= RADIUS]
        passed = _thinned([way[0], *apart, way[-1]])[1:-1]
        return tuple(Goal(float(x), float(y), None) for x, y in passed)

    @cached_property
    def _lines(self) -> list[Array]:
        """The places of each road, no further apart than a step."""
        return [_divided(line) for line in self.lines]

    @cached_property
    def _places(self) -> Array:
        found: Array = np.concatenate(self._lines)
        return found

    @cached_property
    def _costs(self) -> Array:
        """From each place to each other one [m on a road]."""
        places = self._places
        costs: Array = OFF_ROAD * np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
        begin = 0
        for line in self._lines:
            here = begin + np.arange(len(line) - 1)
            along = np.hypot(*np.diff(line, axis=0).T)
            costs[here, here + 1] = costs[here + 1, here] = along
            begin += len(line)
        return costs


def count(lines: Sequence[Sequence[Place]]) -> int:
    """How many places roads have once they are divided."""
    return sum(1 + sum(map(_parts, pairwise(line))) for line in lines)


def _parts(ends: tuple[Place, Place]) -> int:
    return max(1, math.ceil(math.dist(*ends) / STEP))


def _divided(line: Sequence[Place]) -> Array:
    parts = [np.linspace(a, b, _parts((a, b)) + 1)[1:] for a, b in pairwise(line)]
    found: Array = np.concatenate([[line[0]], *parts])
    return found


def _shortest(costs: Array) -> list[int]:
    """The way from place 0 to place 1 that costs least (E. W. Dijkstra, 1959)."""
    total, before = np.full(len(costs), np.inf), np.zeros(len(costs), dtype=int)
    total[0], left = 0.0, np.ones(len(costs), dtype=bool)
    while left[1]:
        here = int(np.where(left, total, np.inf).argmin())
        left[here] = False
        nearer = left & (total[here] + costs[here] < total)
        total[nearer], before[nearer] = total[here] + costs[here][nearer], here
    way = [1]
    while way[-1] != 0:
        way.append(int(before[way[-1]]))
    return way[::-1]


def _thinned(way: Sequence[Array]) -> list[Array]:
    """The same way with fewer places, no further than ASIDE off it (Douglas and Peucker, 1973)."""
    if len(way) < 3:
        return list(way)
    line, places = way[-1] - way[0], np.array(way[1:-1]) - way[0]
    length = max(float(np.hypot(*line)), 1e-9)
    share = np.clip(places @ line / length**2, 0.0, 1.0)
    off = np.hypot(*(places - share[:, None] * line).T)
    farthest = int(off.argmax())
    if off[farthest] <= ASIDE:
        return [way[0], way[-1]]
    return [*_thinned(way[: farthest + 2])[:-1], *_thinned(way[farthest + 1 :])]
