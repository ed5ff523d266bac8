"""What stands on the ground of a site, and how near a machine on tracks comes to it. Frame `map`; m and rad.

A machine is a convex polygon around its footprint, a body the area inside a line of corners that may be bent inwards.
Heights do not count.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tms_config.models import MachineModel
from tms_control.from_above import Polygon, from_above, hull
from tms_control.path import Pose
from tms_reason.reason import Reason

AT_ONCE = 100_000  # corners of bodies at poses that are looked at together: 20 MB

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Outline:
    """What a machine takes up, from the place whose path is planned: a convex polygon, counter-clockwise [m]."""

    polygon: Polygon

    @classmethod
    def rectangle(cls, front: float, back: float, left: float, right: float) -> "Outline":
        """How far it reaches to each side [m]; `back` and `right` are negative."""
        return cls(((back, right), (front, right), (front, left), (back, left)))

    @classmethod
    def of(cls, model: MachineModel) -> "Outline":
        """Around the footprint of a model in base_link; without one, a centimetre."""
        corners = [corner for part in from_above(model).values() for corner in part]
        return cls(hull(corners)) if corners else cls.rectangle(0.01, -0.01, 0.01, -0.01)

    def with_arm(self, corners: Iterable[tuple[float, float]]) -> "Outline | None":
        """Around this and what else it carries at these places; None where that is no larger."""
        found = Outline(hull([*self.polygon, *corners]))
        return None if set(found.polygon) == set(self.polygon) else found

    def seen_from(self, pivot: float) -> "Outline":
        """The same from the place `pivot` [m] ahead."""
        return Outline(tuple((x - pivot, y) for x, y in self.polygon))

    @cached_property
    def corners(self) -> Array:
        """K x 2."""
        return np.array(self.polygon, dtype=float)

    @cached_property
    def ways(self) -> Array:
        """From each corner to the next: K x 2."""
        ways: Array = np.roll(self.corners, -1, axis=0) - self.corners
        return ways

    @cached_property
    def normals(self) -> Array:
        """Outwards across each side: K x 2."""
        across = np.column_stack([self.ways[:, 1], -self.ways[:, 0]])
        normals: Array = across / np.linalg.norm(across, axis=1)[:, None]
        return normals

    @cached_property
    def offsets(self) -> Array:
        """How far each side is from the place, along its normal [m]: K."""
        offsets: Array = (self.normals * self.corners).sum(axis=1)
        return offsets

    @cached_property
    def centre(self) -> Array:
        """A place inside."""
        middle: Array = self.corners.mean(axis=0)
        return middle

    @cached_property
    def half(self) -> float:
        """Radius of a circle round the centre and the whole [m]."""
        return float(np.hypot(*(self.corners - self.centre).T).max())

    @cached_property
    def reach(self) -> float:
        """How far its farthest corner is [m]."""
        return float(np.hypot(*self.corners.T).max())


@dataclass(frozen=True)
class Body:
    """Something that stands there: its corners [m] in order, and how far it may have moved [m] since it was told."""

    name: Reason
    corners: Polygon
    growth: float = 0.0

    @classmethod
    def of(cls, name: Reason, part: Polygon, place: Pose, growth: float) -> "Body":
        """A part of a machine that stands at `place`."""
        c, s = math.cos(place.yaw), math.sin(place.yaw)
        return cls(name, tuple((place.x + c * x - s * y, place.y + s * x + c * y) for x, y in part), growth)

    @cached_property
    def _array(self) -> Array:
        return np.array(self.corners, dtype=float)

    def close(self, places: Array, distance: float) -> NDArray[np.int_]:
        """Numbers of the places (N x 2) that may be nearer than a distance [m]; all others are further away."""
        low, high = self._array.min(axis=0), self._array.max(axis=0)
        middle = (low + high) / 2
        radius = float(np.hypot(*(self._array - middle).T).max())
        from_middle = places - middle
        inside = (np.abs(from_middle) < (high - low) / 2 + distance).all(axis=1)
        return np.flatnonzero(inside & ((from_middle**2).sum(axis=1) < (radius + distance) ** 2))

    def away(self, places: Array) -> Array:
        """How far places (N x 2) are from it [m]: N; 0 inside."""
        seen = self._array - places[:, None]
        way = np.roll(seen, -1, axis=1) - seen
        away = _apart(np.zeros((1, 1, 2)), seen, way)
        away[_inside(seen, way)] = 0.0
        return away

    def all_gaps(self, outline: Outline, poses: Array) -> Array:
        """As `gaps`, for so many poses that they need too much room at once."""
        parts = np.array_split(poses, 1 + len(poses) * len(self.corners) // AT_ONCE)
        return np.concatenate([self.gaps(outline, part) for part in parts])

    def gaps(self, outline: Outline, poses: Array) -> Array:
        """How far a machine is from it [m] at poses (N x 3): N; 0 where they touch."""
        c, s = np.cos(poses[:, 2, None]), np.sin(poses[:, 2, None])
        dx, dy = self._array[:, 0] - poses[:, 0, None], self._array[:, 1] - poses[:, 1, None]
        seen = np.stack([c * dx + s * dy, c * dy - s * dx], axis=2)  # N x corners x 2, from the machine
        way = np.roll(seen, -1, axis=1) - seen
        from_outline = _apart(outline.corners[None], seen, way)
        gaps = np.minimum(from_outline, _apart(seen, outline.corners[None], outline.ways[None]))
        gaps[_crossed(outline, seen, way) | _inside(seen - outline.centre, way)] = 0.0
        return gaps


@dataclass(frozen=True)
class Ground:
    """All bodies of one moment."""

    bodies: tuple[Body, ...] = ()

    def nearer(self, outline: Outline, poses: Array, needed: Array) -> Mask:
        """At which poses (N x 3) a machine is nearer to which body than `needed` [m, by body]: N x bodies."""
        found = np.zeros((len(poses), len(self.bodies)), dtype=bool)
        c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
        (x, y), half = outline.centre, outline.half
        middles = poses[:, :2] + np.column_stack([c * x - s * y, s * x + c * y])
        for number, body in enumerate(self.bodies):
            close = body.close(middles, half + needed[number])
            found[close, number] = body.all_gaps(outline, poses[close]) < needed[number]
        return found


def _apart(points: Array, starts: Array, ways: Array) -> Array:
    """How far the nearest of points (N x P x 2) is from a side (from starts along ways, N x E x 2) [m]: N."""
    to = points[:, :, None] - starts[:, None]
    length = np.maximum((ways**2).sum(axis=2), 1e-12)[:, None]
    share = np.clip((to * ways[:, None]).sum(axis=3) / length, 0.0, 1.0)
    off = to - share[..., None] * ways[:, None]
    gaps: Array = np.hypot(off[..., 0], off[..., 1]).min(axis=(1, 2))
    return gaps


def _crossed(outline: Outline, seen: Array, way: Array) -> Mask:
    """Whether a side of a body goes through the outline: a part of it is inside of all its sides: N."""
    room = outline.offsets - seen @ outline.normals.T  # N x edges x K
    rate = way @ outline.normals.T
    with np.errstate(all="ignore"):
        times = room / rate
    first = np.where(rate < 0, times, 0.0).max(axis=2, initial=0.0)
    last = np.where(rate > 0, times, 1.0).min(axis=2, initial=1.0)
    beside = ((rate == 0) & (room < 0)).any(axis=2)
    crossed: Mask = ((first <= last) & ~beside).any(axis=1)
    return crossed


def _inside(seen: Array, way: Array) -> Mask:
    """Whether the origin is inside a body: a ray from it crosses the body's edges an odd number of times: N."""
    x, y = seen[..., 0], seen[..., 1]
    across = (y > 0) != (np.roll(y, -1, axis=1) > 0)
    with np.errstate(all="ignore"):
        right = x - y * way[..., 0] / way[..., 1] > 0
    inside: Mask = (across & right).sum(axis=1) % 2 == 1
    return inside
