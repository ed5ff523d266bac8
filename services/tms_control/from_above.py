"""A machine from above: its footprint as polygons in base_link [m]."""

import math
from collections.abc import Iterable, Mapping

import numpy as np

from tms_config.models import Box, MachineModel
from tms_control.links import Links, box_corners

SIDES = 16  # of a polygon around a circle: at most 2 % larger
SAME = 0.1  # m by which a box may be larger than a circle on each side and still stand for it

Polygon = tuple[tuple[float, float], ...]  # counter-clockwise


def from_above(model: MachineModel) -> dict[str, Polygon]:
    """By part of the footprint. A box around an upper body that turns is a circle: its corners are never there."""
    circle = _swing(model)
    found: dict[str, Polygon] = {}
    for part, box in model.footprint.items():
        (x0, y0), (x1, y1) = box.min[:2], box.max[:2]
        found[part] = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
        if circle is not None and _stands_for(box, *circle):
            found[part] = around_circle(*circle, SIDES)
    return found


def around_circle(x: float, y: float, radius: float, sides: int) -> Polygon:
    """A regular polygon with a circle [m] inside, as narrow as its number of sides allows."""
    outer = radius / math.cos(math.pi / sides)
    turns = (math.tau * (i + 0.5) / sides for i in range(sides))
    return tuple((x + outer * math.cos(turn), y + outer * math.sin(turn)) for turn in turns)


def arm_from_above(model: MachineModel, links: Links, angles: Mapping[str, float]) -> list[tuple[float, float]]:
    """The corners of what joints move beside the upper body, at their angles [rad]: an arm, a vessel."""
    places = links.places(np.array([[angles[name] for name in links.names]]))
    found = list[tuple[float, float]]()
    for link in sorted(links.moved & model.shapes.keys()):
        x, y, *_ = (places[link][0] @ box_corners(model.shapes[link])).tolist()
        found += zip(x, y, strict=True)
    return found


def _swing(model: MachineModel) -> tuple[float, float, float] | None:
    """The axis about which the upper body turns, x and y, and how far its farthest corner is from it."""
    place = {"base_link": (0.0, 0.0)}
    for name, origin in model.geometry.items():
        x, y = place.get(origin.parent, (0.0, 0.0))
        place[origin.child] = x + origin.xyz[0], y + origin.xyz[1]
        body = model.shapes.get(origin.child)
        if origin.axis == "z" and name in model.joints and body is not None:
            reach = max(math.hypot(a, b) for a in (body.min[0], body.max[0]) for b in (body.min[1], body.max[1]))
            return *place[origin.child], reach
    return None


def _stands_for(box: Box, x: float, y: float, radius: float) -> bool:
    beyond = (x - radius - box.min[0], y - radius - box.min[1], box.max[0] - x - radius, box.max[1] - y - radius)
    return all(abs(one) <= SAME for one in beyond)


def hull(corners: Iterable[tuple[float, float]]) -> Polygon:
    """The convex polygon around places (A. M. Andrew, 1979)."""
    ordered = sorted(set(corners))
    halves = []
    for places in (ordered, ordered[::-1]):
        half: list[tuple[float, float]] = []
        for x, y in places:
            while len(half) > 1 and _right(half[-2], half[-1], (x, y)):
                half.pop()
            half.append((x, y))
        halves += half[:-1]
    return tuple(halves)


def _right(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> bool:
    """Whether the way from a over b to c does not turn to the left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 1e-9
