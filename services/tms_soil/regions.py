"""Which soil lies where, tile by tile."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tms_soil.grid import TILE, tiles_along
from tms_soil.surface import Bounds, Point, inside


def soil_by_tile(bounds: Bounds, regions: Sequence[tuple[int, Sequence[Point]]]) -> NDArray[np.uint8]:
    """The number of the soil of each tile of a ground, by row and column; 0 outside all regions.

    `bounds` [m of map] of the ground; `regions`: numbers of soils, each with the polygon [m of map] in which tiles
    have their middle. The last region counts.
    """
    x0, y0, x1, y1 = bounds
    found = np.zeros((tiles_along(y1 - y0), tiles_along(x1 - x0)), dtype=np.uint8)
    rows, columns = (TILE * (np.arange(count) + 0.5) for count in found.shape)
    x, y = np.meshgrid(x0 + columns, y0 + rows)
    for number, polygon in regions:
        found[inside(polygon, x, y)] = number
    return found
