"""What a straight edge does to the ground: it takes what is above it on its way, and soil is put down in strips.

An edge is two points of map [m], its left and right end seen from the machine: 2 x 3.
"""

import math
from typing import NamedTuple

import numpy as np

from tms_soil.grid import AREA, BANK, COMPACTED, FINE, LOOSE, Grid, Indices, Window
from tms_soil.surface import Array, Bounds


class Swept(NamedTuple):
    """Cells whose middle an edge has passed, and its height [m] when it did."""

    rows: Indices
    columns: Indices
    level: Array


def swept(window: Window, before: Array, after: Array) -> Swept:
    """The cells that an edge passes from one place to the next.

    A cell counts when its middle comes from one side of the edge to the other, so that each is passed exactly once in
    however many steps; an edge that goes straight down, or along itself, passes none.
    """
    a, b = _side(window, before), _side(window, after)
    rows, columns = np.nonzero((a >= 0) != (b >= 0))
    if not rows.size:
        return Swept(rows, columns, np.empty(0))
    a, b = a[rows, columns], b[rows, columns]
    share = (a / (a - b))[:, None]
    left, right = (before[k] + share * (after[k] - before[k]) for k in (0, 1))
    line = right - left
    x, y = window.x[columns] - left[:, 0], window.y[rows, 0] - left[:, 1]
    along = (x * line[:, 0] + y * line[:, 1]) / (line[:, 0] ** 2 + line[:, 1] ** 2)
    inside = (along >= 0) & (along < 1)
    level = left[:, 2] + along * line[:, 2]
    return Swept(rows[inside], columns[inside], level[inside])


def _side(window: Window, edge: Array) -> Array:
    """By its sign, on which side of the line through an edge the middles of cells are [m2]."""
    (x, y), (dx, dy) = edge[0, :2], edge[1, :2] - edge[0, :2]
    side: Array = (window.x - x) * dy - (window.y - y) * dx
    return side


def cut(window: Window, cells: Swept) -> Array:
    """Take what is above the edge, loose soil first; the mass [kg] by index of the grid's soils."""
    rows, columns, level = cells
    layers, thickness = window.of(rows, columns)
    # Nothing is taken where the height is unknown.
    depth = np.fmax(window.datum + (layers * thickness).sum(axis=0) - level, 0.0)
    taken = take_off(layers, thickness, depth)
    window.layers[:, rows, columns] = layers
    return window.by_soil(rows, columns, taken * AREA)


def take_off(layers: Array, thickness: Array, depth: Array) -> Array:
    """Take so much [m] off the top of some cells, loose soil first; returns the mass [kg/m2] of each.

    `layers` [kg/m2], which this changes, and `thickness` [m3/kg] are layer by layer.
    """
    taken = np.zeros(depth.shape)
    for layer in (LOOSE, COMPACTED, BANK):
        part = depth / thickness[layer]
        if layer != BANK:
            part = np.minimum(part, layers[layer])
        layers[layer] -= part
        depth = np.fmax(depth - part * thickness[layer], 0.0)
        taken += part
    return taken


def put_down(grid: Grid, edge: Array, along: Array, mass: float) -> Bounds:
    """Spread a mass [kg] as loose soil evenly over the strip from an edge as far as `along` [m, x and y].

    What would fall outside the site is counted there. Returns where the strip is.
    """
    (x, y), side = edge[0, :2], edge[1, :2] - edge[0, :2]
    corners = np.array([edge[0, :2], edge[1, :2], edge[0, :2] + along, edge[1, :2] + along])
    bounds = around(corners, 0.0)
    window, turn = grid.window(bounds), side[0] * along[1] - side[1] * along[0]
    if window is not None:
        dx, dy = window.x - x, window.y - y
        u, v = (dx * along[1] - dy * along[0]) / turn, (dy * side[0] - dx * side[1]) / turn
        inside = (u >= 0) & (u < 1) & (v >= 0) & (v < 1)
        if count := int(np.count_nonzero(inside)):
            window.layers[LOOSE][inside] += mass / (count * AREA)
            grid.store(window)
            return bounds
    grid.outside += mass
    return bounds


def square_to(edge: Array, way: Array) -> Array:
    """The level unit vector square to an edge, on the side that `way` points to (both x and y)."""
    dx, dy = edge[1, :2] - edge[0, :2]
    square = np.array([-dy, dx]) / math.hypot(dx, dy)
    found: Array = square if square @ way[:2] >= 0 else -square
    return found


def around(points: Array, margin: float) -> Bounds:
    """The rectangle around points, and a margin [m of map]."""
    (x0, y0), (x1, y1) = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    return float(x0) - margin, float(y0) - margin, float(x1) + margin, float(y1) + margin


def depths(window: Window, edge: Array, ahead: Array) -> Array:
    """How deep [m] places along an edge are below the ground a cell ahead of it (unit vector, x and y)."""
    return window.below(_before(edge, ahead))


def piled(window: Window, edge: Array, ahead: Array) -> Array:
    """How high [m] loose soil lies at these places."""
    return window.loose(_before(edge, ahead))


def _before(edge: Array, ahead: Array) -> Array:
    """Points of map a cell ahead of an edge, as many as it passes cells."""
    count = max(2, math.ceil(float(np.hypot(*(edge[1, :2] - edge[0, :2]))) / FINE))
    points: Array = edge[0] + ((np.arange(count) + 0.5) / count)[:, None] * (edge[1] - edge[0])
    return points + FINE * np.append(ahead, 0.0)
