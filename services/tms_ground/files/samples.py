"""What readers make of a file: something that tells heights over a grid, in the coordinates of the file."""

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from tms_ground.reasons import GroundFileLarge, ManyPixels
from tms_reason.errors import TmsError
from tms_soil.surface import Array, Bounds, bilinear

MAX_FILE = 400 * 2**20  # bytes of a file that is read as a whole
MAX_PIXELS = 64 * 2**20  # of a picture, which takes 8 bytes each
MAX_CELLS = 16 * 2**20  # of a grid: 200 m x 200 m have 4 million at 0.1 m


class Places(Protocol):
    """Converts between the coordinates of a file and `map`."""

    def to_map(self, x: Array, y: Array) -> tuple[Array, Array]:
        """X and y [m] in `map`."""

    def from_map(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Coordinates of the file [m or deg]."""


class Samples(Protocol):
    """Heights of a file."""

    @property
    def epsg(self) -> int | None:
        """The coordinates that the file tells; None: it tells none."""

    @property
    def bounds(self) -> Bounds:
        """Where it has heights, in its own coordinates."""

    def over(self, x0: float, y0: float, cell: float, shape: tuple[int, int], places: Places) -> Array:
        """Heights [m] of the cells of a grid in `map`; NaN where it has none."""


@dataclass(frozen=True)
class Raster:
    """Heights at the crossings of lines, in the coordinates of a file."""

    z: Array  # m, (rows, columns); the first row has the least y
    x: float  # of the first column
    y: float  # of the first row
    dx: float  # between columns, above 0
    dy: float  # between rows, above 0
    epsg: int | None = None

    @property
    def bounds(self) -> Bounds:
        rows, columns = self.z.shape
        half_x, half_y = self.dx / 2, self.dy / 2
        return (
            self.x - half_x, self.y - half_y,
            self.x + (columns - 1) * self.dx + half_x, self.y + (rows - 1) * self.dy + half_y,
        )  # fmt: skip

    def over(self, x0: float, y0: float, cell: float, shape: tuple[int, int], places: Places) -> Array:
        """Bilinear at the centres of the cells, some rows at a time, so that little memory is needed."""
        found = np.empty(shape)
        across = x0 + (np.arange(shape[1], dtype=np.float64) + 0.5) * cell
        for row in range(shape[0]):
            up = np.full(shape[1], y0 + (row + 0.5) * cell)
            east, north = places.from_map(across, up)
            found[row] = bilinear(self.z, (east - self.x) / self.dx, (north - self.y) / self.dy)
        return found


def refuse_many(width: int, height: int) -> None:
    """Refuse a picture that would not fit into memory, however small its file is.

    Raises:
        TmsError: it has more than MAX_PIXELS.
    """
    if width * height > MAX_PIXELS:
        raise TmsError(ManyPixels(width, height, MAX_PIXELS))


def refuse_large(path: Path) -> None:
    """Refuse a file that would not fit into memory as a whole.

    Raises:
        TmsError: it is larger than MAX_FILE.
    """
    size = path.stat().st_size
    if size > MAX_FILE:
        raise TmsError(GroundFileLarge(size / 2**20, MAX_FILE / 2**20))
