"""Checks of areas at the border: after them the geometry is simple, small, finite and somewhere on the site."""

import itertools
import math

import numpy as np
import shapely

from tms_areas.areas import AreaSet, Kind, OnLoss, Point, ring
from tms_areas.reasons import (
    AreaTwice,
    CrossesItself,
    FewCorners,
    ManyAreas,
    ManyCorners,
    NeedsNoLoss,
    NeedsSpeed,
    NothingUsable,
    NoUnmanned,
    TooFar,
    TooSmall,
)
from tms_reason.reason import Reason

CORNERS, AREAS = 200, 100  # at most; with all of them the gateway's check still takes less than 2 ms
FARTHEST = 10_000.0  # m from the origin of `map`: further out, a mistake in the coordinates is likelier than a site
SMALLEST = 1.0  # m2


def area_flaw(kind: Kind, corners: list[Point], speed: float | None, on_loss: OnLoss | None) -> Reason | None:
    """What is wrong with one area, its corners in `map` [m]; None if nothing is."""
    if (kind == "speed_limit") != (speed is not None):
        return NeedsSpeed()
    if on_loss is not None and kind != "release":
        return NeedsNoLoss()
    if len(corners) > CORNERS:
        return ManyCorners(len(corners), CORNERS)
    for x, y in corners:
        if not (math.isfinite(x) and math.isfinite(y) and math.hypot(x, y) <= FARTHEST):
            return TooFar(x, y, FARTHEST)
    kept = ring(corners)
    if len(kept) < 3:
        return FewCorners(len(kept))
    polygon = shapely.Polygon(kept)
    if not polygon.is_valid:
        return CrossesItself(*_crossing(kept))
    return TooSmall(polygon.area) if polygon.area < SMALLEST else None


def _crossing(corners: tuple[Point, ...]) -> Point:
    """Where two sides meet that are not neighbours."""
    sides = shapely.linestrings(list(zip(corners, (*corners[1:], corners[0]), strict=True)))
    for number, side in enumerate(sides):
        rest = np.arange(number + 2, len(sides) - (number == 0))
        meets = rest[shapely.intersects(side, sides[rest])]
        if len(meets):
            at = shapely.point_on_surface(shapely.intersection(side, sides[meets[0]]))
            return float(at.x), float(at.y)
    return corners[0]  # neighbouring sides on top of each other


def set_flaw(found: AreaSet) -> Reason | None:
    """What is wrong with a whole set; None if nothing is."""
    ids = [one.id for one in found.areas]
    if len(ids) > AREAS:
        return ManyAreas(len(ids), AREAS)
    twice = next((name for name, after in itertools.pairwise(ids) if name == after), None)
    if twice is not None:
        return AreaTwice(twice)
    if not found.of("unmanned"):
        return NoUnmanned()
    held = frozenset(one.id for one in found.of("release"))
    return NothingUsable() if found.usable(held).area < SMALLEST else None
