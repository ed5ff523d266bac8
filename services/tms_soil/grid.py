"""The ground of a site as mass: square tiles of cells with three layers, bank below compacted below loose soil.

Layers are masses by area [kg/m2], so that a finer cell holds the same numbers, and what moves from cell to cell is
neither lost nor made. Bank counts from the level `datum`: below it its mass is negative, which is as exact. Heights
follow from the densities of the tile's soil; a cell whose bank is NaN has an unknown height, and keeps what falls on
it. Rows run along y and columns along x of the frame `map`, both upwards.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tms_soil.soils import Soil
from tms_soil.surface import Array, Bounds, Heights

Indices = NDArray[np.intp]

FINE, COARSE = 0.1, 0.2  # m, sides of cells where machines work, and elsewhere
AREA = FINE * FINE  # m2
CELLS = 128  # fine cells along a tile's side
TILE = CELLS * FINE  # m
SIDE = round(COARSE / FINE)  # fine cells along a coarse one
COARSE_CELLS = CELLS // SIDE
BANK, COMPACTED, LOOSE = range(3)  # layers of a tile


@dataclass(frozen=True)
class _Piece:
    """The part of a window in one tile."""

    tile: tuple[int, int]
    there: tuple[slice, slice, slice]  # in the tile's layers
    here: tuple[slice, slice, slice]  # in the window's layers


class Window:
    """A rectangle of fine cells, copied out of the grid; `store` of the grid takes it back."""

    def __init__(self, rows: slice, columns: slice, layers: Array, grid: "Grid", pieces: list[_Piece]) -> None:
        """`rows`, `columns`: which fine cells of the grid."""
        self.layers, self.pieces = layers, pieces
        self.datum = grid.datum
        self.x, self.y = grid.x[columns], grid.y[rows, None]  # m, middles of the columns and of the rows
        kinds = sorted({int(grid.soil_of[piece.tile]) for piece in pieces})
        self.soils = [grid.soils[kind] for kind in kinds]  # those that it holds
        self._kinds, self._kind = len(grid.soils), kinds[0]
        self.thickness: Array = grid.thickness[kinds[0]][:, None, None]  # m3/kg by layer
        self._soil: NDArray[np.intp] | None = None  # index of the grid's soils by cell, if there are several
        if len(kinds) > 1:
            self._soil = np.empty(layers.shape[1:], dtype=np.intp)
            for piece in pieces:
                self._soil[piece.here[1:]] = grid.soil_of[piece.tile]
            self.thickness = np.moveaxis(grid.thickness[self._soil], -1, 0)

    def of(self, rows: Indices, columns: Indices) -> tuple[Array, Array]:
        """Layers [kg/m2] of some cells, a copy, and their thickness [m3/kg]; both layer by layer."""
        layers: Array = self.layers[:, rows, columns]
        return layers, self.thickness[:, :, 0] if self._soil is None else self.thickness[:, rows, columns]

    def by_soil(self, rows: Indices, columns: Indices, masses: Array) -> Array:
        """Sum of what was in some cells, by index of the grid's soils."""
        found = np.zeros(self._kinds)
        if self._soil is None:
            found[self._kind] = masses.sum()
        else:
            np.add.at(found, self._soil[rows, columns], masses)
        return found

    def solid(self) -> Array:
        """Heights below the loose soil [m of map]; NaN where they are unknown."""
        thick: Array = self.layers[:LOOSE] * self.thickness[:LOOSE]
        heights: Array = thick[BANK] + thick[COMPACTED] + self.datum
        return heights

    def heights(self) -> Array:
        """Heights of the cells [m of map]; NaN where they are unknown."""
        heights: Array = self.solid() + self.layers[LOOSE] * self.thickness[LOOSE]
        return heights

    def below(self, points: Array) -> Array:
        """How deep [m] points of map (N x 3) are below the ground; 0 above it, and where its height is unknown.

        Of points beside the window the nearest cell counts.
        """
        layers, thickness = self.of(*self._at(points))
        deep: Array = np.fmax((layers * thickness).sum(axis=0) + self.datum - points[:, 2], 0.0)
        return deep

    def loose(self, points: Array) -> Array:
        """How high [m] loose soil lies at points of map, as for `below`."""
        layers, thickness = self.of(*self._at(points))
        high: Array = layers[LOOSE] * thickness[LOOSE]
        return high

    def _at(self, points: Array) -> tuple[Indices, Indices]:
        at = ((points[:, :2] - (self.x[0], self.y[0, 0])) / FINE + 0.5).astype(np.intp)
        rows, columns = (
            np.minimum(np.maximum(at[:, k], 0), size - 1) for k, size in zip((1, 0), self.layers.shape[1:], strict=True)
        )
        return rows, columns


class Grid:
    """The ground of a site."""

    def __init__(self, origin: tuple[float, float], tiles: dict[tuple[int, int], Array], datum: float,
                 soils: Sequence[Soil], soil_of: NDArray[np.uint8]) -> None:  # fmt: skip
        """`origin`: lower left corner [m of map]; `soil_of`: index of `soils` by row and column of tiles."""
        self.x0, self.y0 = origin
        self.datum = datum  # m of map, level from which bank is counted
        self.soils, self.soil_of = tuple(soils), soil_of
        self.thickness: Array = np.array([[1 / one.bank, 1 / one.compacted, 1 / one.loose] for one in soils])  # m3/kg
        self.loose: Array = np.array([one.loose for one in soils])  # kg/m3
        self.outside = 0.0  # kg that has fallen outside the site
        self.x: Array = self.x0 + FINE * (np.arange(soil_of.shape[1] * CELLS, dtype=np.float64) + 0.5)  # m, fine cells
        self.y: Array = self.y0 + FINE * (np.arange(soil_of.shape[0] * CELLS, dtype=np.float64) + 0.5)  # m, fine cells
        self.tiles = tiles  # row and column -> layers, rows, columns [kg/m2]; `window` and `store` are the way to them
        self._size = len(self.y), len(self.x)  # rows and columns of fine cells
        self._top = {tile: self._highest(tile) for tile in tiles}  # m of map, at least

    @classmethod
    def from_heights(cls, heights: Heights, soils: Sequence[Soil], soil_of: NDArray[np.uint8] | None = None) -> "Grid":
        """Ground that nobody has dug yet; `soil_of`: as for the class; absent: the first soil everywhere."""
        x0, y0, x1, y1 = heights.bounds
        rows, columns = tiles_along(y1 - y0), tiles_along(x1 - x0)
        kinds = np.zeros((rows, columns), dtype=np.uint8) if soil_of is None else soil_of
        known = heights.z[np.isfinite(heights.z)]
        datum = float(math.floor(known.min())) if known.size else 0.0
        middles = COARSE * (np.arange(COARSE_CELLS) + 0.5)
        tiles = {}
        for row, column in np.ndindex(rows, columns):
            layers = np.zeros((3, COARSE_CELLS, COARSE_CELLS))
            z = heights.at(*np.meshgrid(x0 + column * TILE + middles, y0 + row * TILE + middles))
            layers[BANK] = (z - datum) * soils[int(kinds[row, column])].bank
            tiles[row, column] = layers
        return cls((x0, y0), tiles, datum, soils, kinds)

    @property
    def bounds(self) -> Bounds:
        """What the grid covers [m of map]."""
        rows, columns = self._size
        return self.x0, self.y0, self.x0 + columns * FINE, self.y0 + rows * FINE

    def window(self, bounds: Bounds) -> Window | None:
        """The cells that touch a rectangle, fine from now on; None outside the site."""
        i0, i1, j0, j1 = self._cells(bounds)
        if i0 >= i1 or j0 >= j1:
            return None
        layers, pieces = np.empty((3, i1 - i0, j1 - j0)), list(_pieces(i0, i1, j0, j1))
        for piece in pieces:
            layers[piece.here] = self._fine(piece.tile)[piece.there]
        return Window(slice(i0, i1), slice(j0, j1), layers, self, pieces)

    def store(self, window: Window) -> None:
        """Take the cells of a window back."""
        top = _highest(window.heights())
        for piece in window.pieces:
            self.tiles[piece.tile][piece.there] = window.layers[piece.here]
            self._top[piece.tile] = max(self._top[piece.tile], top)

    def put_back(self, tile: tuple[int, int], layers: Array) -> None:
        """Give a tile the masses that it had once."""
        self.tiles[tile] = layers
        self._top[tile] = self._highest(tile)

    def top(self, bounds: Bounds) -> float:
        """A height [m of map] that the ground in and near a rectangle nowhere exceeds; -inf outside the site."""
        i0, i1, j0, j1 = self._cells(bounds)
        if i0 >= i1 or j0 >= j1:
            return -math.inf
        tiles = np.ndindex(-(-i1 // CELLS) - i0 // CELLS, -(-j1 // CELLS) - j0 // CELLS)
        return max((self._top[i0 // CELLS + i, j0 // CELLS + j] for i, j in tiles), default=-math.inf)

    def heights(self, bounds: Bounds | None = None, side: int = SIDE) -> Heights:
        """Heights [m of map] in cells of COARSE, for maps, or with a `side` of 1 in those of FINE; NaN where unknown.

        `bounds`: what to show, widened to whole cells; the whole site if it is absent.
        """
        i0, i1, j0, j1 = self._cells(self.bounds if bounds is None else bounds)
        i0, j0, i1, j1 = i0 // side * side, j0 // side * side, -(-i1 // side) * side, -(-j1 // side) * side
        found = np.full((max(0, i1 - i0) // side, max(0, j1 - j0) // side), np.nan)
        for piece in _pieces(i0, i1, j0, j1) if found.size else ():
            here, there = (
                tuple(slice(part.start // side, part.stop // side) for part in parts[1:])
                for parts in (piece.here, piece.there)
            )
            found[here] = self._surface(piece.tile, side)[there]
        return Heights(self.x0 + j0 * FINE, self.y0 + i0 * FINE, side * FINE, found)

    def sample(self, x: Array, y: Array) -> Array:
        """Heights [m of map] of the cells at points; NaN outside and where unknown."""
        found = np.full(x.shape, np.nan)
        for k, (px, py) in enumerate(zip(x, y, strict=True)):
            row, column = (int((v - o) // FINE) for v, o in ((py, self.y0), (px, self.x0)))
            if 0 <= row < self._size[0] and 0 <= column < self._size[1]:
                tile = row // CELLS, column // CELLS
                layers = self.tiles[tile]
                share = layers.shape[1] / CELLS
                at = layers[:, int(row % CELLS * share), int(column % CELLS * share)]
                found[k] = self.datum + at @ self.thickness[self.soil_of[tile]]
        return found

    @property
    def bytes(self) -> int:
        """Memory of the cells."""
        return sum(one.nbytes for one in self.tiles.values())

    def mass(self) -> float:
        """All mass above the datum [kg]; unknown bank counts nothing."""
        return math.fsum(float(np.nansum(one)) * (TILE / one.shape[1]) ** 2 for one in self.tiles.values())

    def _fine(self, tile: tuple[int, int]) -> Array:
        layers = self.tiles[tile]
        if layers.shape[1] < CELLS:
            layers = self.tiles[tile] = _finer(layers)
        return layers

    def _highest(self, tile: tuple[int, int]) -> float:
        layers, thickness = self.tiles[tile], self.thickness[self.soil_of[tile]][:, None, None]
        fine = layers if layers.shape[1] == CELLS else _finer(layers)
        return _highest((fine * thickness).sum(axis=0)) + self.datum

    def _surface(self, tile: tuple[int, int], side: int) -> Array:
        """Heights of a tile [m] in cells of `side` fine ones."""
        layers, thickness = self.tiles[tile], self.thickness[self.soil_of[tile]][:, None, None]
        if side == 1 and layers.shape[1] < CELLS:
            layers = _finer(layers)
        heights: Array = (layers * thickness).sum(axis=0) + self.datum
        count, part = CELLS // side, layers.shape[1] * side // CELLS
        found: Array = heights.reshape(count, part, count, part).mean(axis=(1, 3))
        return found

    def _cells(self, bounds: Bounds) -> tuple[int, int, int, int]:
        """Least row, row behind the last, and the same of columns, of the cells of the site that touch a rectangle."""
        columns = _range(bounds[0] - self.x0, bounds[2] - self.x0, self._size[1])
        return *_range(bounds[1] - self.y0, bounds[3] - self.y0, self._size[0]), *columns


def tiles_along(length: float) -> int:
    """The number of tiles that cover a length [m]."""
    return max(1, math.ceil(length / TILE - 1e-9))


def _finer(layers: Array) -> Array:
    """A coarse tile in fine cells: bank goes on with the slope of its coarse cells, so that a hillside has no steps."""
    found = layers.repeat(SIDE, axis=1).repeat(SIDE, axis=2)
    rise = (np.nan_to_num(slope).repeat(SIDE, axis=0).repeat(SIDE, axis=1) for slope in np.gradient(layers[BANK]))
    middles = np.tile((np.arange(SIDE) + 0.5) / SIDE - 0.5, layers.shape[1])  # of fine cells, in coarse ones
    for slope, place in zip(rise, (middles[:, None], middles), strict=True):
        found[BANK] += slope * place
    return found


def _highest(heights: Array) -> float:
    return float(np.fmax.reduce(heights, axis=None, initial=-math.inf))


def _range(least: float, most: float, size: int) -> tuple[int, int]:
    # A length of 12.8 m are 128 cells, whatever the rounding.
    return max(0, math.floor(least / FINE + 1e-6)), min(size, math.ceil(most / FINE - 1e-6))


def _pieces(i0: int, i1: int, j0: int, j1: int) -> Iterator[_Piece]:
    """The parts of a range of fine cells by tile."""
    for row in range(i0 // CELLS, (i1 - 1) // CELLS + 1):
        a, b = max(i0, row * CELLS), min(i1, (row + 1) * CELLS)
        for column in range(j0 // CELLS, (j1 - 1) // CELLS + 1):
            c, d = max(j0, column * CELLS), min(j1, (column + 1) * CELLS)
            there = slice(None), slice(a - row * CELLS, b - row * CELLS), slice(c - column * CELLS, d - column * CELLS)
            yield _Piece((row, column), there, (slice(None), slice(a - i0, b - i0), slice(c - j0, d - j0)))
