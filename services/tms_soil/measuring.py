"""What was measured changes the ground: newer evidence wins, cell by cell."""

import numpy as np

from tms_soil.cutting import take_off
from tms_soil.evidence import Evidence
from tms_soil.grid import BANK, COMPACTED, LOOSE, TILE, Grid
from tms_soil.surface import Array, Bounds, Heights, Mask


def measured(
    grid: Grid, known: Evidence, seen: Heights, time: float, within: float = 0.0
) -> tuple[list[Bounds], float]:
    """Give the ground heights that were measured at a time [s since 1970], where nothing newer is known.

    Differences up to `within` [m] are noise of the measurement: they renew the evidence and leave the ground. What is
    missing is taken from loose soil first, as by a bucket; what is more counts as loose soil where there is some, else
    as bank. Returns where the ground changed, and the mass that this has made [kg].
    """
    changed, made = [], 0.0
    for tile in _tiles(grid, seen.bounds):
        layers = grid.tiles[tile].copy()
        x, y = _middles(grid, tile, layers.shape[1])
        wanted = np.where(known.at(x, y) >= time, np.nan, seen.at(x, y))
        before = float(np.nansum(layers))
        cells = _measure(layers, grid.thickness[grid.soil_of[tile]], wanted - grid.datum, within)
        if cells.any():
            made += (float(np.nansum(layers)) - before) * (TILE / layers.shape[1]) ** 2
            grid.put_back(tile, layers)
            side = 0.5 * TILE / layers.shape[1]
            changed.append((float(x[cells].min()) - side, float(y[cells].min()) - side,
                            float(x[cells].max()) + side, float(y[cells].max()) + side))  # fmt: skip
    known.learn(seen, time)
    return changed, made


def _tiles(grid: Grid, bounds: Bounds) -> list[tuple[int, int]]:
    """The tiles that touch a rectangle."""
    x0, y0, x1, y1 = bounds
    return [
        (row, column) for row, column in grid.tiles
        if x0 < grid.x0 + (column + 1) * TILE and x1 > grid.x0 + column * TILE
        and y0 < grid.y0 + (row + 1) * TILE and y1 > grid.y0 + row * TILE
    ]  # fmt: skip


def _middles(grid: Grid, tile: tuple[int, int], count: int) -> tuple[Array, Array]:
    middles = TILE * (np.arange(count) + 0.5) / count
    x, y = np.meshgrid(grid.x0 + tile[1] * TILE + middles, grid.y0 + tile[0] * TILE + middles)
    return x, y


def _measure(layers: Array, thickness: Array, wanted: Array, within: float) -> Mask:
    """Bring a tile to heights above the datum [m], where they are known; returns the cells that this has changed."""
    heights = np.tensordot(thickness, layers, axes=1)
    unknown = np.isnan(heights)
    difference = wanted - heights
    cells: Mask = np.isfinite(wanted) & (unknown | (np.abs(np.nan_to_num(difference)) > within))
    rise = np.where(cells & ~unknown, difference, 0.0)
    loose = layers[LOOSE] > 0.0
    layers[LOOSE] += np.where(loose, np.fmax(rise, 0.0), 0.0) / thickness[LOOSE]
    layers[BANK] += np.where(loose, 0.0, np.fmax(rise, 0.0)) / thickness[BANK]
    take_off(layers, thickness, np.fmax(-rise, 0.0))
    new = cells & unknown
    above = layers[COMPACTED] * thickness[COMPACTED] + layers[LOOSE] * thickness[LOOSE]
    layers[BANK][new] = ((wanted - above) / thickness[BANK])[new]
    return cells
