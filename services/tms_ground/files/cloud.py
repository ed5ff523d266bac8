"""Point clouds as LAS and LAZ, read by laspy and lazrs in pieces: a cloud of any size needs the same memory."""

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import laspy
import lazrs
import numpy as np
from laspy.errors import LaspyException
from pyproj import CRS

from tms_ground.files.samples import Places
from tms_ground.reasons import CloudEmpty, GroundFileDamaged, LengthUnit
from tms_reason.errors import TmsError
from tms_soil.surface import Array, Bounds

PIECE = 250_000  # points: about 30 MB with all their fields
UNREADABLE = (LaspyException, lazrs.LazrsError, OSError, ValueError, struct.error)
GROUND, NOISE = 2, (7, 18)  # classes of points, ASPRS LAS 1.4-R15, table 17


@dataclass(frozen=True)
class Cloud:
    """A file of points; a cell has the mean height of its points.

    Where a cell has points that are classified as ground, only these count, so that machines and trees do not.
    """

    path: Path
    epsg: int | None
    bounds: Bounds

    def over(self, x0: float, y0: float, cell: float, shape: tuple[int, int], places: Places) -> Array:
        """Mean heights of the points in each cell.

        Raises:
            TmsError: the file ends early, or is damaged.
        """
        of_ground, of_others = _Means(shape), _Means(shape)
        try:
            with laspy.open(self.path) as reader:
                for points in reader.chunk_iterator(PIECE):
                    x, y = places.to_map(np.asarray(points.x), np.asarray(points.y))
                    at = _cells(x, y, x0, y0, cell, shape)
                    z, kind = np.asarray(points.z), np.asarray(points.classification)
                    valid = (at >= 0) & ~np.isin(kind, NOISE)
                    ground, others = valid & (kind == GROUND), valid & (kind != GROUND)
                    of_ground.add(at[ground], z[ground])
                    of_others.add(at[others], z[others])
        except UNREADABLE as error:
            raise TmsError(GroundFileDamaged(str(error))) from error
        found = of_ground.take()
        np.copyto(found, of_others.take(), where=np.isnan(found))
        return found


class _Means:
    """Means by cell of numbers that come in pieces; works in place, as a grid may have millions of cells."""

    def __init__(self, shape: tuple[int, int]) -> None:
        self._count, self._sum = np.zeros(shape, np.uint32), np.zeros(shape)

    def add(self, at: Any, z: Array) -> None:
        """Numbers, and which cell (counted along rows) each belongs to."""
        np.add.at(self._count.reshape(-1), at, 1)
        np.add.at(self._sum.reshape(-1), at, z)

    def take(self) -> Array:
        """The means, once; NaN where nothing came."""
        self._sum[self._count == 0] = np.nan
        np.divide(self._sum, self._count, out=self._sum, where=self._count > 0)
        return self._sum


def read(path: Path) -> Cloud:
    """A cloud's head; its points are read later.

    Raises:
        TmsError: it is no LAS or LAZ, or holds no points.
    """
    try:
        with laspy.open(path) as reader:
            head = reader.header
            system = head.parse_crs()
    except UNREADABLE as error:
        raise TmsError(GroundFileDamaged(str(error))) from error
    if not head.point_count:
        raise TmsError(CloudEmpty())
    if system is not None:
        _refuse_feet(system)
    bounds = (float(head.x_min), float(head.y_min), float(head.x_max), float(head.y_max))
    return Cloud(path, None if system is None else _horizontal(system).to_epsg(), bounds)


def _horizontal(system: CRS) -> CRS:
    """The part of coordinates that is about places; the other one is about heights."""
    return system.sub_crs_list[0] if system.is_compound else system


def _refuse_feet(system: CRS) -> None:
    for part in system.sub_crs_list if system.is_compound else ():
        for axis in part.axis_info:
            if axis.direction == "up" and axis.unit_name != "metre":
                raise TmsError(LengthUnit(axis.unit_name))


def _cells(x: Array, y: Array, x0: float, y0: float, cell: float, shape: tuple[int, int]) -> Any:
    """Which cell each point is in, counted along rows; -1: none."""
    rows, columns = shape
    column, row = np.floor((x - x0) / cell), np.floor((y - y0) / cell)
    there = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
    return np.where(there, row * columns + column, -1.0).astype(np.intp)
