"""When the height of each place of a site was last measured, or changed by a machine."""

import math
from collections.abc import Iterable

import numpy as np

from tms_soil.grid import COARSE
from tms_soil.surface import Array, Bounds, Heights, grid


class Evidence:
    """Times [s since 1970] by cells of COARSE; NaN where there is none."""

    def __init__(self, bounds: Bounds) -> None:
        """`bounds`: of the site [m of map]."""
        known = grid(bounds, COARSE)
        self.x0, self.y0, self.times = known.x0, known.y0, known.z

    def add(self, places: Iterable[Bounds], time: float) -> None:
        """Note that rectangles [m of map] became known at a time."""
        for x0, y0, x1, y1 in places:
            self.times[_range(y0 - self.y0, y1 - self.y0), _range(x0 - self.x0, x1 - self.x0)] = time

    def learn(self, seen: Heights, time: float) -> None:
        """Note that heights were measured at a time, where they are known and nothing newer is."""
        x0, y0, x1, y1 = seen.bounds
        part = _range(y0 - self.y0, y1 - self.y0), _range(x0 - self.x0, x1 - self.x0)
        middles = (COARSE * (np.arange(size) + 0.5) for size in self.times.shape)
        rows, columns = (one[cut] for one, cut in zip(middles, part, strict=True))
        there = np.isfinite(seen.at(*np.meshgrid(self.x0 + columns, self.y0 + rows)))
        times = self.times[part]
        times[there & ~(times >= time)] = time

    def at(self, x: Array, y: Array) -> Array:
        """Times of the cells at places; NaN outside, too."""
        rows, columns = (np.floor((v - o) / COARSE).astype(np.intp) for v, o in ((y, self.y0), (x, self.x0)))
        there = (rows >= 0) & (rows < self.times.shape[0]) & (columns >= 0) & (columns < self.times.shape[1])
        return np.where(there, self.times[np.where(there, rows, 0), np.where(there, columns, 0)], math.nan)


def _range(least: float, most: float) -> slice:
    return slice(max(0, math.floor(least / COARSE + 1e-6)), max(0, math.ceil(most / COARSE - 1e-6)))
