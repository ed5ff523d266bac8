"""The ground around a machine as boxes in its base_link: as few as show its heights well enough.

A part is as high as its highest place. That in which most lies above the ground is halved, until each part is nearly
level or there are too many.
"""

import heapq
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tms_config.models import Box, Tracks
from tms_control.links import Array, Matrix, placed
from tms_rp.reasons import Ground
from tms_rp.scene import Obstacle, Region
from tms_soil.driving import standing
from tms_soil.surface import Heights

CELL = 0.2  # m, between two looks at the ground
REACH = 12.8  # m on each side, further than any arm reaches
DEEP = 3.0  # m, of the boxes
LEVEL = 0.1  # m, by which the ground in a box may differ, as long as there are not ...
MOST = 100  # ... so many boxes


@dataclass(frozen=True)
class _Part:
    """Some cells of a region: its number, their rows and columns, and how high they are [m]."""

    region: int
    rows: slice
    columns: slice
    top: float
    low: float

    @property
    def size(self) -> int:
        return len(range(self.rows.start, self.rows.stop)) * len(range(self.columns.start, self.columns.stop))

    @property
    def rough(self) -> bool:
        return self.top - self.low > LEVEL and self.size > 1

    @property
    def rank(self) -> tuple[float, int, int, int]:
        """The least is halved first."""
        return (self.low - self.top) * self.size, self.region, self.rows.start, self.columns.start


class Terrain:
    """The ground of one moment; equal to no other."""

    def __init__(self, heights: Heights, tracks: Tracks | None, place: tuple[float, float, float]) -> None:
        """`heights` in map; `place`: x, y [m] and yaw [rad] of base_link there, where it stands on its tracks."""
        self._heights = heights
        self._stands = _stand(heights, tracks, place)

    @cached_property
    def whole(self) -> tuple[Obstacle, ...]:
        """All of the ground; nothing may be in it."""
        return self.obstacles(np.eye(4), [Region(-REACH, REACH, -REACH, REACH)])

    def obstacles(self, frame: Matrix, regions: Sequence[Region]) -> tuple[Obstacle, ...]:
        """The ground in some regions of a frame (4 x 4, in base_link)."""
        sampled = [self._sampled(frame, one) for one in regions]
        return tuple(_box(frame, regions[one.region], sampled[one.region].shape, one) for one in _parts(sampled))

    def _sampled(self, frame: Matrix, region: Region) -> Array:
        """Heights [m, base_link] in the middles of a region's cells; where nothing is known, as high as the tracks."""
        rows, columns = (_count(region.left - region.right), _count(region.far - region.near))
        x = region.near + (np.arange(columns) + 0.5) / columns * (region.far - region.near)
        y = region.right + (np.arange(rows) + 0.5) / rows * (region.left - region.right)
        points = np.stack([*np.meshgrid(x, y), np.zeros((rows, columns)), np.ones((rows, columns))], axis=-1)
        there = points @ (self._stands @ frame).T
        there[..., 2] = self._heights.at(there[..., 0], there[..., 1])
        z: Array = (there @ np.linalg.inv(self._stands).T)[..., 2]
        return np.nan_to_num(z, nan=0.0)


def _stand(heights: Heights, tracks: Tracks | None, place: tuple[float, float, float]) -> Matrix:
    def sample(x: Array, y: Array) -> Array:
        return heights.at(x, y)

    if tracks is not None:
        return standing(tracks, sample, *place)
    found = placed(*place)
    found[2, 3] = np.nan_to_num(heights.at(np.array(place[0]), np.array(place[1])))
    return found


def _count(length: float) -> int:
    return max(1, round(length / CELL))


def _box(frame: Matrix, region: Region, shape: tuple[int, ...], part: _Part) -> Obstacle:
    wide, long = (region.left - region.right) / shape[0], (region.far - region.near) / shape[1]
    sides = (part.columns.stop - part.columns.start) * long, (part.rows.stop - part.rows.start) * wide
    corner = np.eye(4)
    corner[:3, 3] = region.near + part.columns.start * long, region.right + part.rows.start * wide, part.top
    # Sizes are those of whole cells: each new one costs a body for ever.
    box = Box(min=(0.0, 0.0, -DEEP), max=(round(sides[0], 6), round(sides[1], 6), 0.0))
    return Obstacle(Ground(), box, frame @ corner, lets=region.lets)


def _parts(regions: Sequence[Array]) -> list[_Part]:
    """Parts of some regions, given by their heights, in which the ground is nearly level."""
    found, rough = list[_Part](), list[tuple[tuple[float, int, int, int], _Part]]()

    def add(region: int, rows: slice, columns: slice) -> None:
        cells = regions[region][rows, columns]
        one = _Part(region, rows, columns, float(cells.max()), float(cells.min()))
        if one.rough:
            heapq.heappush(rough, (one.rank, one))
        else:
            found.append(one)

    for number, z in enumerate(regions):
        add(number, slice(0, z.shape[0]), slice(0, z.shape[1]))
    while rough and len(found) + len(rough) < MOST:
        _, one = heapq.heappop(rough)
        for rows, columns in _halves(one.rows, one.columns):
            add(one.region, rows, columns)
    return found + [one for _, one in rough]


def _halves(rows: slice, columns: slice) -> list[tuple[slice, slice]]:
    high, wide = rows.stop - rows.start, columns.stop - columns.start
    if high >= wide:
        middle = rows.start + high // 2
        return [(slice(rows.start, middle), columns), (slice(middle, rows.stop), columns)]
    middle = columns.start + wide // 2
    return [(rows, slice(columns.start, middle)), (rows, slice(middle, columns.stop))]
