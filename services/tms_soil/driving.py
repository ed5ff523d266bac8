"""Tracks and blades on the ground: how a machine stands on it, what tracks press, what a blade grades."""

import math
from collections.abc import Callable

import numpy as np

from tms_config.models import Blade, Tracks
from tms_control.links import Matrix, placed
from tms_soil.cutting import around, cut, depths, piled, put_down, square_to, swept
from tms_soil.grid import COMPACTED, FINE, LOOSE, Grid, Window
from tms_soil.resistance import GRAVITY, force
from tms_soil.surface import Array, Bounds, Mask

PLACES = np.linspace(0.0, 1.0, 5)  # along a track, at which the ground is looked at
PRESSES = 0.1  # m, way after which tracks press anew: a cell
WINDROW = 0.4  # m, depth of the strip on which a blade leaves what it pushes
RAKE = math.radians(60)  # rad, of a blade: ours
HIGH = 0.9  # m, of a blade: what is piled higher runs over it
STANDS = 1e-4  # m, motion of an edge that has no direction


def standing(tracks: Tracks, sample: Callable[[Array, Array], Array], x: float, y: float, yaw: float) -> Matrix:
    """The place of base_link in map for a machine that stands at x, y [m], by height and slope under its tracks.

    `sample`: heights [m] at places. Where the ground is unknown it counts as level, at the height 0 if all of it is.
    """
    flat, contact = placed(x, y, yaw), _contact(tracks)
    heights = sample(*(contact @ flat[:3, :3].T + flat[:3, 3])[:, :2].T)
    known = np.isfinite(heights)
    if not known.any():
        return flat
    ahead, aside, up = _plane(contact, heights, known)
    place = flat.copy()
    z = np.array([-ahead, -aside, 1.0]) / math.sqrt(1 + ahead * ahead + aside * aside)
    front = np.array([1.0, 0.0, ahead]) / math.hypot(1.0, ahead)
    place[:3, :3] = flat[:3, :3] @ np.column_stack((front, np.cross(z, front), z))
    place[2, 3] = up
    return place


def _contact(tracks: Tracks) -> Array:
    """Places along both tracks [m, base_link]."""
    x = tracks.rear + PLACES * (tracks.front - tracks.rear)
    return np.array([(one, side, 0.0) for side in (tracks.gauge / 2, -tracks.gauge / 2) for one in x])


def _plane(contact: Array, heights: Array, known: Mask) -> tuple[float, float, float]:
    """Rise ahead and to the left, and the height [m] in the middle, of the plane nearest to the known heights."""
    filled = np.where(known, heights, heights[known].mean())
    sides = np.column_stack((contact[:, :2], np.ones(len(filled))))
    ahead, aside, up = np.linalg.lstsq(sides, filled, rcond=None)[0]
    return float(ahead), float(aside), float(up)


class Rolling:
    """Two tracks: a pass of their length turns two thirds of the loose soil below them into compacted soil."""

    def __init__(self, tracks: Tracks, grid: Grid) -> None:
        self._tracks, self._grid = tracks, grid
        self._pressed: Matrix | None = None  # place of base_link when they last pressed
        self._contact = _contact(tracks)

    def stand(self, x: float, y: float, yaw: float) -> Matrix:
        """The place of base_link in map for a machine that stands at x, y [m]; see `standing`."""
        return standing(self._tracks, self._grid.sample, x, y, yaw)

    def step(self, place: Matrix) -> list[Bounds]:
        """Move base_link to a place in map; returns where the ground changed."""
        before = self._pressed
        if before is None:
            self._pressed = place
            return []
        way = max(math.dist(*((end @ one[:3, :3].T + one[:3, 3]) for one in (before, place)))
                  for end in self._contact[[0, -1]])  # fmt: skip
        if way < PRESSES:
            return []
        self._pressed = place
        contact = self._contact @ place[:3, :3].T + place[:3, 3]
        bounds = around(contact, self._tracks.width / 2)
        window = self._grid.window(bounds)
        if window is None or not window.layers[LOOSE].any():
            return []
        dx, dy = window.x - place[0, 3], window.y - place[1, 3]
        ahead, left = (dx * place[0, k] + dy * place[1, k] for k in (0, 1))
        below = (ahead >= self._tracks.rear) & (ahead <= self._tracks.front)
        below &= np.abs(np.abs(left) - self._tracks.gauge / 2) <= self._tracks.width / 2
        pressed = window.layers[LOOSE] * below * -math.expm1(-way / (self._tracks.front - self._tracks.rear))
        window.layers[LOOSE] -= pressed
        window.layers[COMPACTED] += pressed
        self._grid.store(window)
        return [bounds]


class Grader:
    """A blade: it cuts what is above its edge, and fills what is below with what it pushes."""

    def __init__(self, blade: Blade, grid: Grid) -> None:
        self._blade, self._grid = blade, grid
        self.resistance = 0.0  # N; a blade that stands keeps what it met
        (x, z), side = blade.edge, blade.width / 2
        self._edge = np.array([(x, side, z), (x, -side, z)])

    def step(self, before: Matrix, after: Matrix) -> list[Bounds]:
        """Move the blade's link from one place in map to the next; returns where the ground changed."""
        old, new = (self._edge @ place[:3, :3].T + place[:3, 3] for place in (before, after))
        way = (new - old).mean(axis=0)
        if float(np.linalg.norm(way)) < STANDS:
            return []
        self.resistance = 0.0
        bounds = around(np.concatenate((old, new)), 2 * FINE)
        if math.hypot(way[0], way[1]) < STANDS or float(new[:, 2].min()) > self._grid.top(bounds):
            return []
        window = self._grid.window(bounds)
        if window is None:
            return []
        ahead = square_to(new, way)
        deep = depths(window, new, ahead)
        if deep.any():
            self.resistance = self._force(window, deep, piled(window, new, ahead))
        cells = swept(window, old, new)
        taken = float(cut(window, cells).sum()) if cells.rows.size else 0.0
        if taken == 0.0:
            return []
        self._grid.store(window)
        return [around(new, FINE), put_down(self._grid, new, WINDROW * ahead, taken)]

    def _force(self, window: Window, deep: Array, high: Array) -> float:
        """Force [N] of the solid ground that it cuts, `deep` [m] with what lies on it, and of the pile that it pushes.

        The pile is as high as loose soil lies just ahead, and slopes away from there; it slides on soil.
        """
        soil = window.soils[0]
        solid, high = np.maximum(deep - high, 0.0), np.minimum(np.minimum(high, deep), HIGH)
        mass = soil.loose * self._blade.width * float(np.square(high).mean()) / (2 * soil.repose_slope)
        slides = mass * GRAVITY * math.tan(math.radians(soil.friction))
        return slides + force(soil, RAKE, self._blade.width, solid)
