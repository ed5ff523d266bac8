"""Where people are a danger to themselves among machines: the areas of a site as an intruder sees them."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.ops import unary_union

from tms_areas.areas import AreaSet, Point

NEAR = 1.0  # m; a restricted area that comes so near to an unmanned one belongs to it

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Found:
    """Somebody in an area."""

    area: str
    x: float  # m, map
    y: float  # m, map
    inside: bool  # the unmanned area; else the restricted one around it


class Zones:
    """One set of areas. An unmanned area ends where a manned or restricted one begins.

    Machines share a piece when they could drive to each other: someone in it is among all of them.
    """

    def __init__(self, areas: AreaSet) -> None:
        manned = [one.polygon for one in areas.of("manned")]
        restricted = areas.of("restricted")
        unmanned = unary_union([one.polygon for one in areas.of("unmanned")])
        free = unmanned.difference(unary_union([*manned, *(one.polygon for one in restricted)]))
        self._pieces = shapely.get_parts(free)
        self._manned, self._restricted = unary_union(manned), restricted
        self._unmanned = areas.of("unmanned")
        for shape in (*self._pieces, self._manned, *(one.polygon for one in (*self._unmanned, *restricted))):
            shapely.prepare(shape)

    def share(self, area: str, here: Point | None) -> bool:
        """Whether a machine at a place is, or may come, where an unmanned area is; None: its place is not known.

        An area that is not among the enabled ones may be anywhere.
        """
        shapes = [one.polygon for one in self._unmanned if one.id == area]
        return not shapes or any(shapely.intersects(piece, shape) for piece in self._of(here) for shape in shapes)

    def found(self, places: Array, around: float, here: Point | None) -> Found | None:
        """The first of some places (N x 2) that endangers, or comes near to, a machine.

        `around`: m by which the places may be off. Whoever is in a manned area may be there.
        """
        if not len(places):
            return None
        points = shapely.points(places)
        points, places = points[outside := ~shapely.intersects(self._manned, points)], places[outside]
        pieces = self._of(here)
        for piece in pieces:
            if len(hit := places[shapely.dwithin(piece, points, around)]):
                return Found(self._area_of(hit[0]), float(hit[0, 0]), float(hit[0, 1]), inside=True)
        for area in self._restricted:
            if any(shapely.dwithin(area.polygon, piece, NEAR) for piece in pieces):
                if len(hit := places[shapely.dwithin(area.polygon, points, around)]):
                    return Found(area.id, float(hit[0, 0]), float(hit[0, 1]), inside=False)
        return None

    def _of(self, here: Point | None) -> list[shapely.Geometry]:
        """The piece of a machine; all of them where that is not known."""
        pieces = [] if here is None else [one for one in self._pieces if shapely.intersects_xy(one, *here)]
        return pieces or list(self._pieces)

    def _area_of(self, place: Array) -> str:
        point = shapely.Point(place)
        return min(self._unmanned, key=lambda one: float(shapely.distance(one.polygon, point))).id
