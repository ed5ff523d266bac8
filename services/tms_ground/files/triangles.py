"""Surfaces of triangles (TIN), and their heights over a grid."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from tms_ground.files.samples import Places
from tms_soil.surface import Array, Bounds

AT_ONCE = 500_000  # cells that are looked at together
EDGE = 1e-9  # share of a triangle by which a place on its side may seem to be outside


@dataclass(frozen=True)
class Triangles:
    """A surface of triangles, in the coordinates of a file."""

    points: Array  # (points, 3): east, north, height [m]
    corners: Any  # (triangles, 3): numbers of points
    epsg: int | None = None

    @property
    def bounds(self) -> Bounds:
        used = self.points[np.unique(self.corners)]
        least, most = used.min(axis=0), used.max(axis=0)
        return float(least[0]), float(least[1]), float(most[0]), float(most[1])

    def over(self, x0: float, y0: float, cell: float, shape: tuple[int, int], places: Places) -> Array:
        """Heights of the triangles at the centres of the cells."""
        x, y = places.to_map(self.points[:, 0], self.points[:, 1])
        # In cells, 0 at the centre of the first one.
        points = np.column_stack(((x - x0) / cell - 0.5, (y - y0) / cell - 0.5, self.points[:, 2]))
        return heights(points[self.corners], shape)


def heights(triangles: Array, shape: tuple[int, int]) -> Array:
    """Heights at whole rows and columns.

    Args:
        triangles: (triangles, 3 corners, 3): column, row, height [m].
        shape: rows, columns.
    """
    found = np.full(shape, np.nan)
    rows, columns = shape
    first_row, last_row = _span(triangles[:, :, 1], rows)
    first, last = _span(triangles[:, :, 0], columns)
    height = np.where(last >= first, np.maximum(last_row - first_row + 1, 0), 0)
    which = np.repeat(np.arange(len(triangles)), height)  # a line: one triangle in one row
    row = first_row[which] + _counted(height)
    width = (last - first + 1)[which]
    ends = np.cumsum(width)
    begin = 0
    while begin < len(which):
        done = ends[begin - 1] if begin else 0
        end = max(begin + 1, int(np.searchsorted(ends, done + AT_ONCE, side="right")))
        part = slice(begin, end)
        cells = np.repeat(np.arange(begin, end), width[part])
        column = first[which[cells]] + _counted(width[part])
        _fill(found, triangles[which[cells]], row[cells], column)
        begin = end
    return found


def _span(places: Array, size: int) -> tuple[Any, Any]:
    """First and last whole number between the corners of each triangle, within a grid."""
    first = np.clip(np.ceil(places.min(axis=1) - EDGE), 0, size).astype(np.intp)
    last = np.clip(np.floor(places.max(axis=1) + EDGE), -1, size - 1).astype(np.intp)
    return first, last


def _counted(sizes: Any) -> Any:
    """0, 1, ... up to each size, one after the other."""
    ends = np.cumsum(sizes)
    return np.arange(int(ends[-1]) if len(ends) else 0) - np.repeat(ends - sizes, sizes)


def _fill(found: Array, triangles: Array, row: Any, column: Any) -> None:
    """Write the heights of triangles at places that are inside them."""
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (triangles[:, corner].T for corner in range(3))
    size = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    flat = size == 0.0  # its corners are on one line
    size = np.where(flat, 1.0, size)
    b = ((column - ax) * (cy - ay) - (cx - ax) * (row - ay)) / size
    c = ((bx - ax) * (row - ay) - (column - ax) * (by - ay)) / size
    within = ~flat & (b >= -EDGE) & (c >= -EDGE) & (b + c <= 1 + EDGE)
    z = az + b * (bz - az) + c * (cz - az)
    found[row[within], column[within]] = z[within]
