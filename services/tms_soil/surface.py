"""Surfaces over the frame `map`: heights on a grid, a plane, a pit with slopes. Each tells its height [m] at places.

A height is NaN where nothing is known, or where a design says nothing.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Point = tuple[float, float]  # x, y [m]
Bounds = tuple[float, float, float, float]  # least x, least y, largest x, largest y [m]

SAME_PLACE = 1e-6  # cells


class Surface(Protocol):
    """What has a height at each place."""

    def at(self, x: Array, y: Array) -> Array:
        """Heights [m] at places [m, map]; NaN where it says nothing."""


@dataclass(frozen=True)
class Heights:
    """Heights of square cells. A row is a line along x; rows follow each other along y."""

    x0: float  # m, map: the corner of the first cell with the least x ...
    y0: float  # m, map: ... and the least y
    cell: float  # m, side of a cell
    z: Array  # m, (rows, columns), at the centres of the cells; NaN: unknown

    @property
    def bounds(self) -> Bounds:
        rows, columns = self.z.shape
        return self.x0, self.y0, self.x0 + columns * self.cell, self.y0 + rows * self.cell

    @property
    def centres(self) -> tuple[Array, Array]:
        """X and y [m] of the centre of each cell, both (rows, columns)."""
        rows, columns = self.z.shape
        x, y = np.meshgrid(np.arange(columns) + 0.5, np.arange(rows) + 0.5)
        return self.x0 + x * self.cell, self.y0 + y * self.cell

    def at(self, x: Array, y: Array) -> Array:
        """Bilinear between the centres of four cells, as far out as half a cell from the outermost centres."""
        return bilinear(self.z, (x - self.x0) / self.cell - 0.5, (y - self.y0) / self.cell - 0.5)

    def on(self, grid: "Heights") -> Array:
        """Its heights at the cells of another grid; those of the same grid are taken as they are."""
        if (self.x0, self.y0, self.cell, self.z.shape) == (grid.x0, grid.y0, grid.cell, grid.z.shape):
            return self.z
        return self.at(*grid.centres)


@dataclass(frozen=True)
class Plane:
    """A level or sloping plane."""

    z: float  # m, at the place (x, y)
    slope_x: float = 0.0  # rise per length along x
    slope_y: float = 0.0  # rise per length along y
    x: float = 0.0  # m
    y: float = 0.0  # m

    def at(self, x: Array, y: Array) -> Array:
        """Heights [m] at places [m, map]."""
        return self.z + self.slope_x * (x - self.x) + self.slope_y * (y - self.y)


@dataclass(frozen=True)
class Pit:
    """A level floor with slopes that rise from its sides up to the rim; beyond the rim the design says nothing."""

    floor: Sequence[Point]  # corners [m, map], in either order
    level: float  # m, height of the floor
    slope: float  # rise per length, above 0; 1:1.5 is 1 / 1.5
    rim: float  # m, height at which the slopes end

    def at(self, x: Array, y: Array) -> Array:
        """Heights [m] at places [m, map]; round corners, since all slopes are equally steep."""
        z = self.level + self.slope * np.where(inside(self.floor, x, y), 0.0, distance(self.floor, x, y))
        return np.where(z <= self.rim, z, np.nan)


def bilinear(z: Array, column: Array, row: Array) -> Array:
    """Heights between the cells of a grid.

    Args:
        z: (rows, columns).
        column: in cells, 0 at the centre of the first one; half a cell beyond the outermost centres is still inside.
        row: likewise.
    """
    rows, columns = z.shape
    there = (column >= -0.5) & (column <= columns - 0.5) & (row >= -0.5) & (row <= rows - 0.5)
    left = np.clip(np.floor(column), 0, max(columns - 2, 0)).astype(np.intp)
    below = np.clip(np.floor(row), 0, max(rows - 2, 0)).astype(np.intp)
    right, above = np.minimum(left + 1, columns - 1), np.minimum(below + 1, rows - 1)
    u, v = _share(column - left), _share(row - below)
    lower = _mixed(z[below, left], z[below, right], u)
    upper = _mixed(z[above, left], z[above, right], u)
    return np.where(there, _mixed(lower, upper, v), np.nan)


def _share(part: Array) -> Array:
    """How far a place is to the next cell; a place at a centre stays there in spite of rounding."""
    nearest = np.round(part)
    return np.clip(np.where(np.abs(part - nearest) < SAME_PLACE, nearest, part), 0.0, 1.0)


def _mixed(first: Array, second: Array, share: Array) -> Array:
    """Between two heights; an unknown one that has no share does not count."""
    mixed = first + share * (second - first)
    return np.where(share == 0.0, first, np.where(share == 1.0, second, mixed))


def inside(polygon: Sequence[Point], x: Array, y: Array) -> Mask:
    """Which places [m] lie in a polygon: a ray along x crosses its sides an odd number of times."""
    found: Mask = np.zeros(np.broadcast(x, y).shape, dtype=np.bool_)
    for (x1, y1), (x2, y2) in _sides(polygon):
        if y1 != y2:
            found ^= ((y1 > y) != (y2 > y)) & (x < x1 + (y - y1) * (x2 - x1) / (y2 - y1))
    return found


def distance(polygon: Sequence[Point], x: Array, y: Array) -> Array:
    """Distance [m] of places to the nearest side of a polygon."""
    nearest = np.full(np.broadcast(x, y).shape, np.inf)
    for (x1, y1), (x2, y2) in _sides(polygon):
        dx, dy = x2 - x1, y2 - y1
        length = dx * dx + dy * dy
        along = np.clip(((x - x1) * dx + (y - y1) * dy) / length, 0.0, 1.0) if length > 0 else np.zeros_like(nearest)
        nearest = np.minimum(nearest, np.hypot(x - x1 - along * dx, y - y1 - along * dy))
    return nearest


def grid(bounds: Bounds, cell: float) -> Heights:
    """An unknown ground that covers bounds [m]; its side is rounded up to whole cells [m]."""
    x0, y0, x1, y1 = bounds
    shape = _cells(y1 - y0, cell), _cells(x1 - x0, cell)
    return Heights(x0, y0, cell, np.full(shape, np.nan))


def _cells(length: float, cell: float) -> int:
    return max(1, math.ceil(length / cell - 1e-6))  # 20 m are 100 cells of 0.2 m, whatever the rounding


def _sides(polygon: Sequence[Point]) -> list[tuple[Point, Point]]:
    return list(zip(polygon, [*polygon[1:], polygon[0]], strict=True))
