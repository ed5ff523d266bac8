"""Slopes that are too steep give way: cut faces crumble into loose soil, and loose soil runs down to its repose.

What runs from a cell to its neighbour follows the slope of the surface there, whatever its direction, so that piles
become round. It leaves one cell and comes to the other as the same number, so mass stays what it is.
"""

import numpy as np
from numpy.typing import NDArray

from tms_soil.grid import BANK, COMPACTED, FINE, LOOSE, Window
from tms_soil.surface import Array, Bounds

SWEEPS = 10  # at most, in a step of 20 ms
CELLS = 40_000  # in all sweeps of a step at most, but for one sweep: bounds the time of a step
MIDDLE = 0.985  # of the slope of repose, at which soil rests: some places stay half a degree steeper
RATE = 0.25  # of what is too high, between two cells in a sweep: the largest that is stable
FEW = 0.1  # kg/m2: less does not run; a slope is then steeper than its repose by an eighth of a degree at most
EDGE = 0.005  # m, of a face that is too high and stands
MARGIN = 3 * FINE  # m around soil that runs, into which it may run
TINY = 1e-12


def settle(window: Window) -> Bounds | None:
    """Let slopes give way for a step; returns where soil still runs [m of map]."""
    if min(window.layers.shape[1:]) < 3:
        return None  # in the corner of a site
    crumbled = _crumble(window)
    solid, loose, thickness = window.solid(), window.layers[LOOSE], window.thickness[LOOSE]
    run = MIDDLE * min(soil.repose_slope for soil in window.soils) * FINE  # m from cell to cell
    pace = RATE / float(thickness[0, 0])  # kg/m2 for a metre; that of one of the soils is near enough
    unknown = bool(np.isnan(solid).any())
    for _ in range(min(SWEEPS, max(1, CELLS // loose.size))):
        flows = _flows(solid + loose * thickness, loose, run, pace)
        if unknown:
            flows = np.nan_to_num(flows[0], copy=False), np.nan_to_num(flows[1], copy=False)
        if max(np.abs(flow).max() for flow in flows) < FEW:
            break
        loose[1:-1, :-1] += flows[0]
        loose[1:-1, 1:] -= flows[0]
        loose[:-1, 1:-1] += flows[1]
        loose[1:, 1:-1] -= flows[1]
    rows, columns = (np.zeros(size, dtype=np.bool_) for size in loose.shape)
    for flow, (i, j) in zip(flows, ((1, 0), (0, 1)), strict=True):
        runs = np.abs(flow) >= FEW
        rows[i : i + runs.shape[0]] |= runs.any(axis=1)
        columns[j : j + runs.shape[1]] |= runs.any(axis=0)
    return _around(window, rows, columns) if rows.any() else _around(window, *crumbled) if crumbled else None


def _flows(heights: Array, loose: Array, run: float, pace: float) -> tuple[Array, Array]:
    """What runs from each cell to the one before it along x, and along y [kg/m2]; not along the window's border.

    Each neighbour gets a quarter of a cell's loose soil at most.
    """
    dx, dy = heights[:, 1:] - heights[:, :-1], heights[1:] - heights[:-1]
    beside_x, beside_y = dy[:-1] + dy[1:], dx[:, :-1] + dx[:, 1:]
    most, found = 0.25 * loose, []
    for d, beside, to, out_of in (
        (dx[1:-1], beside_x[:, :-1] + beside_x[:, 1:], most[1:-1, :-1], most[1:-1, 1:]),
        (dy[:, 1:-1], beside_y[:-1] + beside_y[1:], most[:-1, 1:-1], most[1:, 1:-1]),
    ):
        slope = np.sqrt(d * d + 0.0625 * beside * beside)
        flow = d * np.fmax(pace - pace * run / np.maximum(slope, TINY), 0.0)
        found.append(np.maximum(np.minimum(flow, out_of), -to))
    return found[0], found[1]


def _crumble(window: Window) -> tuple[NDArray[np.bool_], NDArray[np.bool_]] | None:
    """Turn half of what stands too steeply into loose soil; the rows and columns where it does."""
    solid, heights = window.solid(), window.heights()
    inner = solid[1:-1, 1:-1]
    lowest = np.fmin(np.fmin(heights[1:-1, :-2], heights[1:-1, 2:]), np.fmin(heights[:-2, 1:-1], heights[2:, 1:-1]))
    over = inner - lowest - min(soil.face_slope for soil in window.soils) * FINE
    rows, columns = np.nonzero(over > EDGE)
    if not rows.size:
        return None
    depth = 0.5 * over[rows, columns]
    rows, columns = rows + 1, columns + 1
    layers, thickness = window.of(rows, columns)
    compacted = np.minimum(layers[COMPACTED], depth / thickness[COMPACTED])
    bank = (depth - compacted * thickness[COMPACTED]) / thickness[BANK]
    layers[COMPACTED] -= compacted
    layers[BANK] -= bank
    layers[LOOSE] += compacted + bank
    window.layers[:, rows, columns] = layers
    return np.isin(np.arange(solid.shape[0]), rows), np.isin(np.arange(solid.shape[1]), columns)


def _around(window: Window, rows: NDArray[np.bool_], columns: NDArray[np.bool_]) -> Bounds:
    i, j = np.flatnonzero(rows), np.flatnonzero(columns)
    return (
        float(window.x[j[0]]), float(window.y[i[0], 0]),
        float(window.x[j[-1]]), float(window.y[i[-1], 0]),
    )  # fmt: skip
