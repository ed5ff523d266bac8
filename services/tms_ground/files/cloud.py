"""Point clouds as LAS and LAZ, read by laspy and lazrs in pieces: a cloud of any size needs the same memory."""

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import laspy
import lazrs
import numpy as np
from laspy.errors import LaspyException
from pyproj import CRS
from pyproj.exceptions import CRSError

from tms_ground.files.pieces import refuse_false_sizes
from tms_ground.files.samples import Places
from tms_ground.reasons import CloudEmpty, CloudEndsEarly, GroundFileDamaged, LengthUnit
from tms_reason.errors import TmsError
from tms_soil.surface import Array, Bounds

PIECE = 250_000  # points: about 30 MB with all their fields
UNREADABLE = (LaspyException, lazrs.LazrsError, CRSError, OSError, OverflowError, ValueError, struct.error)
PANIC = "pyo3_runtime"  # module of what lazrs raises where its own code gives up; it cannot be imported
# Of one thread: that of several makes room for what a damaged table tells of its pieces, and ends the process.
BACKEND = laspy.LazBackend.Lazrs
HEAD = 375  # bytes of the head of LAS 1.4
# Numbers of records in the head: offset, least bytes of a record, first minor version (LAS 1.4-R15, tables 3, 5, 6).
RECORDS = ((100, 54, b"\0"), (243, 60, b"\4"))
POINTS, FORMAT, COMPRESSED = 96, 104, 0x80  # offsets in the head: where points begin, their format; its bit for LAZ
LEAST_CHUNK = 20  # bytes of a compressed piece: its first point is not compressed
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
        with _readable(), laspy.open(self.path, laz_backend=BACKEND) as reader:
            left = reader.header.point_count
            while left > 0:
                points = reader.read_points(min(PIECE, left))
                left -= len(points)
                if not len(points):  # of a LAS that was cut off
                    raise TmsError(CloudEndsEarly(reader.header.point_count))
                x, y = places.to_map(np.asarray(points.x), np.asarray(points.y))
                at = _cells(x, y, x0, y0, cell, shape)
                z, kind = np.asarray(points.z), np.asarray(points.classification)
                valid = (at >= 0) & ~np.isin(kind, NOISE)
                ground, others = valid & (kind == GROUND), valid & (kind != GROUND)
                of_ground.add(at[ground], z[ground])
                of_others.add(at[others], z[others])
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
    with _readable():
        _refuse_false_counts(path)
        with laspy.open(path, laz_backend=BACKEND) as reader:
            head = reader.header
            refuse_false_sizes(path, head)
            system = head.parse_crs()
    if not head.point_count:
        raise TmsError(CloudEmpty())
    if system is not None:
        _refuse_feet(system)
    bounds = (float(head.x_min), float(head.y_min), float(head.x_max), float(head.y_max))
    return Cloud(path, None if system is None else _horizontal(system).to_epsg(), bounds)


@contextmanager
def _readable() -> Iterator[None]:
    """Turn what the libraries raise for a damaged file into a TmsError; numbers beyond all bounds are no places."""
    try:
        with np.errstate(over="ignore", invalid="ignore"):
            yield
    except UNREADABLE as error:
        raise TmsError(GroundFileDamaged(str(error))) from error
    except BaseException as error:
        if type(error).__module__ != PANIC:
            raise
        raise TmsError(GroundFileDamaged(str(error))) from error


def _refuse_false_counts(path: Path) -> None:
    """Refuse a head that tells of more than fits into the file: libraries would read for hours, or end the process."""
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(HEAD)
        told = [(_number(head[at : at + 4]), least) for at, least, since in RECORDS if head[25:26] >= since]
        if len(head) > FORMAT and head[FORMAT] & COMPRESSED:
            told.append((_chunks(file, _number(head[POINTS : POINTS + 4]), size), LEAST_CHUNK))
    for count, least in told:
        if count * least > size:
            raise TmsError(GroundFileDamaged(f"{count} x {least} B > {size} B"))


def _chunks(file: BinaryIO, begin: int, size: int) -> int:
    """Number of compressed pieces in a LAZ, from their table, whose place is told where points begin, or at the end."""
    file.seek(begin)
    place = int.from_bytes(file.read(8), "little", signed=True)
    if place == -1:
        file.seek(max(0, size - 8))
        place = int.from_bytes(file.read(8), "little", signed=True)
    file.seek(place + 4)
    return _number(file.read(4))


def _number(data: bytes) -> int:
    return int.from_bytes(data, "little")


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
