"""An excavator's bucket: it digs, carries, spills and dumps."""

import math
from collections.abc import Sequence

import numpy as np

from tms_config.models import Bucket
from tms_control.links import Matrix
from tms_soil.capacity import Capacity, tilt_of
from tms_soil.cutting import around, cut, depths, put_down, square_to, swept
from tms_soil.grid import Grid, Window
from tms_soil.hauling import Hauler
from tms_soil.resistance import GRAVITY, force
from tms_soil.surface import Array, Bounds

REACH = 0.3  # m around the bucket in which the ground is looked at
WINDROW = 0.3  # m, depth of the strip on which a full bucket leaves what it pushes
FALLS = 0.4  # m, depth of the strip on which soil from a bucket comes down
EMPTIES = 0.3  # s, time constant of soil that runs out of a bucket: ours, so that it is empty 1 to 2 s after it opened
REST = 1.0  # kg, what is less runs out at once
STANDS = 1e-4  # m, motion of an edge that has no direction
OPENING = np.linspace(0.1, 0.9, 5)[:, None]  # places along an opening, or a lip


class Digger:
    """One bucket and its load."""

    def __init__(self, bucket: Bucket, grid: Grid) -> None:
        self._grid, self._bucket = grid, bucket
        self._capacities = [Capacity(bucket, soil.repose_slope) for soil in grid.soils]
        self.load: Array = np.zeros(len(grid.soils))  # kg by soil
        self.resistance = 0.0  # N, against the cutting edge; an edge that stands keeps what it met
        side, (lip, edge) = bucket.width / 2, (bucket.section[0], bucket.section[-1])
        # Cutting edge left and right, rear lip left and right, and where the plate behind the edge comes from.
        points = [(edge, side), (edge, -side), (lip, side), (lip, -side), (bucket.section[-2], 0.0)]
        self._points = np.array([(x, y, z) for (x, z), y in points])

    @property
    def volume(self) -> float:
        """Volume of the load, loose [m3]."""
        return float((self.load / self._grid.loose).sum())

    @property
    def capacity(self) -> float:
        """What digging fills it with at most, loose [m3]."""
        kind = int(self.load.argmax())
        return self._grid.soils[kind].fill * self._capacities[kind].heaped

    def holds(self, place: Matrix) -> float:
        """What stays in its present load's soil [m3, loose] in the air, with the bucket's link at `place`."""
        return self._capacities[int(self.load.argmax())].at(tilt_of(place[:3, :3]))

    def lip(self, place: Matrix) -> Array:
        """Points of map [m] along the lower lip, from which soil falls, with the bucket's link at `place`."""
        return _along(_lower(self._points[:4] @ place[:3, :3].T + place[:3, 3]))

    def step(self, before: Matrix, after: Matrix, seconds: float, haulers: Sequence[Hauler]) -> list[Bounds]:
        """Move the bucket's link from one place in map to the next; returns where the ground changed."""
        old, new = (self._points @ place[:3, :3].T + place[:3, 3] for place in (before, after))
        way = new[:2].mean(axis=0) - old[:2].mean(axis=0)
        changed, covered = list[Bounds](), 0.0
        if float(np.linalg.norm(way)) >= STANDS:
            self.resistance = 0.0
        bounds, low = around(np.concatenate((old, new)), REACH), min(float(old[:4, 2].min()), float(new[:4, 2].min()))
        window = self._grid.window(bounds) if low < self._grid.top(bounds) else None
        if window is not None:
            changed += self._dig(window, old, new, way)
            opening = new[2:4].mean(axis=0) + OPENING * (new[:2].mean(axis=0) - new[2:4].mean(axis=0))
            covered = float(np.count_nonzero(window.below(opening))) / len(OPENING)
        surplus = self._surplus(after, covered)
        if surplus > 0.0 and covered > 0.0:
            pushed = float(self._take(surplus).sum())
            changed.append(put_down(self._grid, new[:2], WINDROW * square_to(new[:2], way), pushed))
        elif surplus > 0.0:
            changed += self._spill(_lower(new), self._take(surplus * -math.expm1(-seconds / EMPTIES)), haulers)
        return changed

    def _dig(self, window: Window, old: Array, new: Array, way: Array) -> list[Bounds]:
        """Take what the edge has passed on its way: into the bucket, or before it, if the bucket moves backwards."""
        length = float(np.linalg.norm(way))
        if length < STANDS:
            return []
        ahead = square_to(new[:2], way)
        plate, soil = new[4] - new[:2].mean(axis=0), window.soils[0]
        deep = depths(window, new[:2], ahead)
        if deep.any():
            rake = math.acos(max(-1.0, min(1.0, float(-plate @ way) / (length * float(np.linalg.norm(plate))))))
            self.resistance = force(soil, rake, self._bucket.width, deep) + float(self.load.sum()) * GRAVITY
        cells = swept(window, old[:2], new[:2])
        taken = cut(window, cells) if cells.rows.size else np.zeros(0)
        if not taken.any():
            return []
        self._grid.store(window)
        bounds = around(new[:2], REACH)
        if float(way @ self._outward(new)) >= 0.0:
            self.load += taken
            return [bounds]
        return [bounds, put_down(self._grid, new[:2], WINDROW * ahead, float(taken.sum()))]

    def _outward(self, points: Array) -> Array:
        """The direction in which the opening faces."""
        return np.cross(points[0] - points[1], points[0] - points[2])

    def _surplus(self, place: Matrix, covered: float) -> float:
        """What the bucket cannot keep [kg]; the ground before it keeps in what its opening is below."""
        total = float(self.load.sum())
        if total == 0.0:
            return 0.0
        kind = int(self.load.argmax())
        capacity, soil = self._capacities[kind], self._grid.soils[kind]
        open_, filled = capacity.at(tilt_of(place[:3, :3])), soil.fill * capacity.heaped
        keeps = (1 - covered) * open_ + covered * filled
        return total * max(0.0, 1.0 - keeps / self.volume)

    def _take(self, mass: float) -> Array:
        """Take a mass [kg] out of the load, of each soil its share; all, if hardly anything would stay."""
        total = float(self.load.sum())
        out = self.load.copy() if total - mass < REST else self.load * (mass / total)
        self.load -= out
        return out

    def _spill(self, lip: Array, out: Array, haulers: Sequence[Hauler]) -> list[Bounds]:
        """Let soil [kg] fall from a lip, into vessels below it or to the ground; returns where the ground changed."""
        if not out.any():
            return []
        places, changed = _along(lip), list[Bounds]()
        for hauler in haulers:
            if share := hauler.below(places):
                caught = share * out
                changed += hauler.take(caught, places.mean(axis=0))
                out = out - caught
        if out.any():
            along = FALLS * square_to(lip, np.ones(2))
            start = lip - 0.5 * np.append(along, 0.0)
            changed.append(put_down(self._grid, start, along, float(out.sum())))
        return changed


def _lower(points: Array) -> Array:
    """Left and right end of the lip that is lower: of the cutting edge or the rear lip."""
    return points[:2] if points[0, 2] + points[1, 2] < points[2, 2] + points[3, 2] else points[2:4]


def _along(lip: Array) -> Array:
    found: Array = lip[0] + OPENING * (lip[1] - lip[0])
    return found
