"""ASCII grids of Esri (.asc): a head of keys, then rows of heights from north to south."""

from pathlib import Path
from typing import TextIO

import numpy as np

from tms_ground.files.samples import Raster, refuse_large
from tms_ground.reasons import GridKeyMissing, GridKeyValue, GridSize, GroundFileDamaged
from tms_reason.errors import TmsError
from tms_soil.surface import Array, Heights

KEYS = {"ncols", "nrows", "xllcorner", "yllcorner", "xllcenter", "yllcenter", "cellsize", "nodata_value"}
UNKNOWN = -9999.0


def read(path: Path) -> Raster:
    """The heights of a grid; it does not tell its coordinates.

    Raises:
        TmsError: the head is incomplete, or there are not as many heights as it tells.
    """
    refuse_large(path)
    try:
        with path.open(encoding="ascii") as file:
            head, line = _head(file)
            rows, columns = int(_positive(head, "nrows")), int(_positive(head, "ncols"))
            file.seek(line)
            z = np.loadtxt(file, dtype=np.float64, ndmin=2)
    except ValueError as error:  # a word that is no number, a row of another length, a letter that is not ASCII
        raise TmsError(GroundFileDamaged(str(error))) from error
    if z.shape != (rows, columns):
        raise TmsError(GridSize(z.shape[0], z.shape[1], rows, columns))
    cell = _positive(head, "cellsize")
    x, y = _first(head, "x", cell), _first(head, "y", cell)
    return Raster(_known(z, head.get("nodata_value", UNKNOWN))[::-1], x, y, cell, cell)


def write(path: Path, ground: Heights) -> None:
    """Write heights in `map` [m, millimetres] into a new file.

    Raises:
        OSError: the file is there already, or cannot be written.
    """
    rows, columns = ground.z.shape
    with path.open("x", encoding="ascii") as file:
        file.write(f"ncols {columns}\nnrows {rows}\nxllcorner {ground.x0:.6f}\nyllcorner {ground.y0:.6f}\n")
        file.write(f"cellsize {ground.cell:.6f}\nNODATA_value {UNKNOWN:.0f}\n")
        np.savetxt(file, np.where(np.isfinite(ground.z), ground.z, UNKNOWN)[::-1], fmt="%.3f")


def _head(file: TextIO) -> tuple[dict[str, float], int]:
    """The keys, and where the first row begins."""
    found: dict[str, float] = {}
    place = file.tell()
    while line := file.readline():
        words = line.split()
        if not words or words[0].lower() not in KEYS:
            break
        found[words[0].lower()] = float(words[1]) if len(words) == 2 else np.nan
        place = file.tell()
    return found, place


def _positive(head: dict[str, float], key: str) -> float:
    if key not in head:
        raise TmsError(GridKeyMissing(key))
    value = head[key]
    if not (np.isfinite(value) and value > 0):
        raise TmsError(GridKeyValue(key, str(value)))
    return value


def _first(head: dict[str, float], axis: str, cell: float) -> float:
    """The centre of the first cell along an axis."""
    corner, centre = f"{axis}llcorner", f"{axis}llcenter"
    if corner not in head and centre not in head:
        raise TmsError(GridKeyMissing(corner))
    value = head[centre] if centre in head else head[corner] + cell / 2
    if not np.isfinite(value):
        raise TmsError(GridKeyValue(corner, str(value)))
    return value


def _known(z: Array, unknown: float) -> Array:
    return np.where(np.isfinite(z) & (z != unknown), z, np.nan)
