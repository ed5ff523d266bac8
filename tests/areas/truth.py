"""Whether a machine truly is where it may be: geometry of its own, by winding numbers of many points of its edges."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SPACING = 0.1  # m between points of an edge that are looked at


def inside(points: Array, polygon: Array) -> NDArray[np.bool_]:
    """Which points (N x 2) a polygon (K x 2) winds round (D. Sunday, 2001)."""
    a, b = polygon, np.concatenate([polygon[1:], polygon[:1]])
    x, y = points[:, 0, None], points[:, 1, None]
    left = (b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (x - a[:, 0]) * (b[:, 1] - a[:, 1])
    up = (a[:, 1] <= y) & (b[:, 1] > y) & (left > 0)
    down = (a[:, 1] > y) & (b[:, 1] <= y) & (left < 0)
    return (up.sum(axis=1) - down.sum(axis=1)) != 0


class Rules:
    """The areas, each as its corners."""

    def __init__(self, allowed: Sequence[Array], closed: Sequence[Array]) -> None:
        self._allowed, self._closed = allowed, closed

    def broken(self, outline: Array, x: float, y: float, yaw: float) -> bool:
        """Whether a machine stands where it must not; `outline`: points of its edge, as `edge` makes them."""
        c, s = math.cos(yaw), math.sin(yaw)
        at = np.column_stack([x + c * outline[:, 0] - s * outline[:, 1], y + s * outline[:, 0] + c * outline[:, 1]])
        may = np.zeros(len(at), dtype=bool)
        for polygon in self._allowed:
            may |= inside(at, polygon)
        if not may.all():
            return True
        for polygon in self._closed:
            if inside(at, polygon).any() or inside(polygon, at).any():
                return True
        return False


def edge(corners: Array) -> Array:
    """Points of a polygon's edge."""
    found = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        count = max(1, math.ceil(float(np.hypot(*(b - a))) / SPACING))
        found.append(a + np.linspace(0.0, 1.0, count, endpoint=False)[:, None] * (b - a))
    return np.concatenate(found)
