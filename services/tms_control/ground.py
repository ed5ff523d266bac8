"""What stands on the ground of a site, and how near a machine on tracks comes to it. Frame `map`; m and rad.

A machine is the rectangle around its footprint, a body the area inside a line of corners that may be bent inwards.
Heights do not count.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tms_config.models import Box
from tms_control.path import Pose
from tms_reason.reason import Reason

AT_ONCE = 100_000  # corners of bodies at poses that are looked at together: 20 MB

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Outline:
    """How far a machine reaches from the place whose path is planned [m]; `back` and `right` are negative."""

    front: float
    back: float
    left: float
    right: float

    @classmethod
    def of(cls, footprint: Iterable[Box]) -> "Outline":
        """The rectangle around boxes in base_link; without any, the place alone."""
        boxes = list(footprint)
        corners = np.array([(*box.min[:2], *box.max[:2]) for box in boxes] or [(0.0, 0.0, 0.0, 0.0)])
        (back, right), (front, left) = corners[:, :2].min(axis=0), corners[:, 2:].max(axis=0)
        return cls(float(front), float(back), float(left), float(right))

    def seen_from(self, pivot: float) -> "Outline":
        """The same from the place `pivot` [m] ahead."""
        return Outline(self.front - pivot, self.back - pivot, self.left, self.right)

    @cached_property
    def corners(self) -> Array:
        """4 x 2."""
        return np.array([[x, y] for x in (self.back, self.front) for y in (self.right, self.left)])

    @cached_property
    def centre(self) -> Array:
        """Of the rectangle."""
        middle: Array = self.corners.mean(axis=0)
        return middle

    @cached_property
    def half(self) -> float:
        """Half of its diagonal [m]."""
        return math.hypot(self.front - self.back, self.left - self.right) / 2

    @cached_property
    def reach(self) -> float:
        """How far its farthest corner is [m]."""
        return float(np.hypot(*self.corners.T).max())


@dataclass(frozen=True)
class Body:
    """Something that stands there: its corners [m] in order, and how far it may have moved [m] since it was told."""

    name: Reason
    corners: tuple[tuple[float, float], ...]
    growth: float = 0.0

    @classmethod
    def of(cls, name: Reason, box: Box, place: Pose, growth: float) -> "Body":
        """A box of a footprint, in the frame of a machine that stands at `place`."""
        (x0, y0), (x1, y1) = box.min[:2], box.max[:2]
        turn = Pose(0.0, 0.0, -place.yaw)
        seen = (turn.seen(Pose(x, y, 0.0)) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1)))
        return cls(name, tuple((place.x + x, place.y + y) for x, y in seen), growth)

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
        return self.all_gaps(Outline(0.0, 0.0, 0.0, 0.0), np.column_stack([places, np.zeros(len(places))]))

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
        gaps = np.minimum(_to_corners(outline, seen), _to_edges(outline, seen, way))
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


def _to_corners(outline: Outline, seen: Array) -> Array:
    """How far the nearest corner of a body is from the rectangle [m]: N."""
    beyond = np.maximum(seen - [outline.front, outline.left], [outline.back, outline.right] - seen)
    gaps: Array = np.hypot(*np.moveaxis(np.maximum(beyond, 0.0), 2, 0)).min(axis=1)
    return gaps


def _to_edges(outline: Outline, seen: Array, way: Array) -> Array:
    """How far the nearest corner of the rectangle is from an edge of a body [m]: N."""
    to = outline.corners[None, None] - seen[:, :, None]  # N x edges x 4 x 2
    length = np.maximum((way**2).sum(axis=2), 1e-12)[..., None]
    share = np.clip((to * way[:, :, None]).sum(axis=3) / length, 0.0, 1.0)
    off = to - share[..., None] * way[:, :, None]
    gaps: Array = np.hypot(off[..., 0], off[..., 1]).min(axis=(1, 2))
    return gaps


def _crossed(outline: Outline, seen: Array, way: Array) -> Mask:
    """Whether an edge of a body goes through the rectangle (its part between both pairs of sides): N."""
    with np.errstate(all="ignore"):
        low = ([outline.back, outline.right] - seen) / way
        high = ([outline.front, outline.left] - seen) / way
    first, last = np.fmax(np.fmin(low, high), 0.0).max(axis=2), np.fmin(np.fmax(low, high), 1.0).min(axis=2)
    crossed: Mask = (first <= last).any(axis=1)
    return crossed


def _inside(seen: Array, way: Array) -> Mask:
    """Whether the origin is inside a body: a ray from it crosses the body's edges an odd number of times: N."""
    x, y = seen[..., 0], seen[..., 1]
    across = (y > 0) != (np.roll(y, -1, axis=1) > 0)
    with np.errstate(all="ignore"):
        right = x - y * way[..., 0] / way[..., 1] > 0
    inside: Mask = (across & right).sum(axis=1) % 2 == 1
    return inside
