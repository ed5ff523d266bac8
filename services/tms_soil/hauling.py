"""A carrier's vessel: it takes what falls into it, and lets it slide out when it tips."""

import math

import numpy as np

from tms_config.models import Vessel
from tms_control.links import Matrix
from tms_soil.capacity import tilt_of
from tms_soil.cutting import put_down, square_to
from tms_soil.grid import Grid
from tms_soil.resistance import GRAVITY
from tms_soil.surface import Array, Bounds

# How soil slides out, as in OperaSim-AGX: it begins when friction lets it, and its speed has a limit.
LEVEL = math.radians(10)  # rad, below which nothing slides
FRICTION = 0.4
CROWDED = 4.0  # times the friction while the soil behind the vessel reaches up to it: 3 to 6 there
FASTEST = 2.0  # m/s, times the sine of the tilt
OPENS = 0.9  # of the width, through which soil comes out
STRIP = 0.5  # m, depth of the strip on which soil comes down
REST = 0.005  # m3, what is less slides out at once


class Hauler:
    """One vessel and its load."""

    def __init__(self, vessel: Vessel, grid: Grid) -> None:
        self._vessel, self._grid = vessel, grid
        self._least, self._most = np.array(vessel.min), np.array(vessel.max)
        self._length = vessel.max[0] - vessel.min[0]
        self.load: Array = np.zeros(len(grid.soils))  # kg by soil
        self._place: Matrix | None = None  # of its link in map
        self._speed = 0.0  # m/s of soil that slides

    @property
    def volume(self) -> float:
        """Volume of the load, loose [m3]."""
        return float((self.load / self._grid.loose).sum())

    @property
    def capacity(self) -> float:
        """What it holds at most, loose [m3]."""
        return self._vessel.heaped

    @property
    def middle(self) -> Array | None:
        """The middle of its inside [m of map]; None while its place is not known."""
        return None if self._place is None else self._in_map(tuple(0.5 * (self._least + self._most)))[0]

    def below(self, points: Array) -> float:
        """The share of points of map [m] from which soil falls into it."""
        if self._place is None:
            return 0.0
        seen = (points - self._place[:3, 3]) @ self._place[:3, :3]
        inside = (seen[:, :2] >= self._least[:2]) & (seen[:, :2] <= self._most[:2])
        return float((inside.all(axis=1) & (seen[:, 2] > self._least[2])).mean())

    def take(self, soil: Array, point: Array) -> list[Bounds]:
        """Take soil [kg] that falls in at a point of map; what is too much falls over the nearest side."""
        self.load += soil
        over = 1.0 - self._vessel.heaped / self.volume
        if over <= 0.0 or self._place is None:
            return []
        out = over * self.load
        self.load -= out
        left = float(((point - self._place[:3, 3]) @ self._place[:3, :3])[1]) >= 0.0
        y, z = (self._most[1] if left else self._least[1]), self._most[2]
        edge = self._in_map((self._least[0], y, z), (self._most[0], y, z))
        outward = self._place[:2, 1] * (1.0 if left else -1.0)
        return [put_down(self._grid, edge, STRIP * square_to(edge, outward), float(out.sum()))]

    def step(self, place: Matrix, seconds: float) -> list[Bounds]:
        """Move the vessel's link to a place in map; returns where the ground changed."""
        self._place = place
        tilt = -tilt_of(place[:3, :3])  # a negative pitch tips it over its rear end
        if tilt < LEVEL or not self.load.any():
            self._speed = 0.0
            return []
        width = OPENS * 0.5 * (self._most[1] - self._least[1])
        (x, _, z), middle = self._least, 0.5 * (self._most[1] + self._least[1])
        edge = self._in_map((x, middle + width, z), (x, middle - width, z))
        outward = STRIP * square_to(edge, -place[:2, 0])
        friction = FRICTION * (CROWDED if self._crowded(edge, outward) else 1.0)
        pull = GRAVITY * (math.sin(tilt) - friction * math.cos(tilt))
        self._speed = min(max(0.0, self._speed + pull * seconds), FASTEST * math.sin(tilt))
        share = -math.expm1(-OPENS * self._speed * seconds / self._length)
        out = self.load.copy() if self._speed and self.volume * (1 - share) < REST else share * self.load
        self.load -= out
        return [put_down(self._grid, edge, outward, float(out.sum()))] if out.any() else []

    def _crowded(self, edge: Array, outward: Array) -> bool:
        ends = np.append(outward, 0.0) + edge
        heights = self._grid.sample(ends[:, 0], ends[:, 1])
        return bool(np.nanmax(heights, initial=-math.inf) >= edge[:, 2].mean())

    def _in_map(self, *points: tuple[float, float, float]) -> Array:
        assert self._place is not None
        return np.array(points) @ self._place[:3, :3].T + self._place[:3, 3]
