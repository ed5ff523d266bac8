"""How far a machine comes until it stands, and what it covers meanwhile: geometry of the law of areas."""

import math
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from tms_areas.areas import Area
from tms_areas.body import Body
from tms_areas.braking import Axis
from tms_areas.fix import WINDOW, Motion

STEP, TURN = 0.5, 0.1  # m and rad between looks at a path

Array = NDArray[np.float64]
Shapes = NDArray[np.object_]
Place = tuple[float, float, float]  # x, y [m], yaw [rad] in `map`


@dataclass(frozen=True)
class Reach:
    """How far the base can come until it stands: the least and the most forward [m], to the left [m], and turned."""

    back: float
    ahead: float
    side: float
    right: float  # rad
    left: float  # rad
    around: float  # m in any direction in addition

    @property
    def most(self) -> float:
        """For people: what it needs to stop [m]."""
        return max(abs(self.back), abs(self.ahead), abs(self.side)) + self.around


@dataclass(frozen=True)
class Covered:
    """A convex polygon for each part of a machine, and how much around it [m] the part may cover too."""

    shapes: Shapes
    around: Array

    @property
    def parts(self) -> list[tuple[BaseGeometry, float]]:
        """Each with what is around it."""
        return list(zip(self.shapes, self.around.tolist(), strict=True))

    def touches(self, area: Area) -> bool:
        """Whether a part of the machine may be in an area."""
        return bool(shapely.dwithin(area.polygon, self.shapes, self.around).any())


def ends(axis: Axis, speed: float, blind: float, factor: float) -> tuple[float, float]:
    """The least and the most that an axis can go on from a measured speed until it stands [m or rad]."""
    gain = axis.acceleration * (blind + WINDOW / 2)
    low, high = max(speed - gain, min(speed, -axis.top)), min(speed + gain, max(speed, axis.top))
    ends = [one * blind + math.copysign(axis.braking(one), one) * factor for one in (low, high)]
    return ends[0], ends[1]


def between(old: Place, new: Place) -> list[tuple[float, Place]]:
    """Places on the straight way from one to another, both included, each with its share of the way."""
    way, turn = math.dist(old[:2], new[:2]), math.remainder(new[2] - old[2], math.tau)
    shares = np.linspace(0.0, 1.0, 2 + int(max(way / STEP, abs(turn) / TURN))).tolist()
    return [
        (share, (old[0] + share * (new[0] - old[0]), old[1] + share * (new[1] - old[1]), old[2] + share * turn))
        for share in shares
    ]


def shape_of(body: Body, motion: Motion) -> BaseGeometry:
    """What a machine covers where it is."""
    return shapely.union_all(parts_of(body, motion).geoms)


def parts_of(body: Body, motion: Motion) -> shapely.GeometryCollection:
    """What its parts cover where it is; that is as far from others as `shape_of`, which takes longer to make."""
    corners, part_of = _corners(body, place_of(motion))
    return shapely.geometrycollections(shapely.polygons(shapely.linearrings(corners, indices=part_of)))


def place_of(motion: Motion) -> Array:
    """Where the base is, as one of several places (1 x 3)."""
    return np.array([[motion.x, motion.y, motion.yaw]])


def places_of(motion: Motion, reach: Reach) -> Array:
    """Places (N x 3) between and around which the base is until it stands."""
    turns = sorted({reach.right, (reach.right + reach.left) / 2, reach.left})
    ends = [(turn, way) for turn in turns for way in {reach.back, reach.ahead}]
    turn, ahead = np.array([(turn * share, way * share) for turn, way in ends for share in (0.5, 1.0)]).T
    side = np.tile([0.5 * reach.side, reach.side], len(ends))
    c, s = np.cos(motion.yaw + turn / 2), np.sin(motion.yaw + turn / 2)
    x, y = motion.x + c * ahead - s * side, motion.y + s * ahead + c * side
    return np.concatenate([place_of(motion), np.stack([x, y, motion.yaw + turn], axis=1)])


def covered_by(body: Body, places: Array, between: float, around: float) -> Covered:
    """What each part covers at places (N x 3), between them, and at headings that are `between` [rad] off."""
    corners, part_of = _corners(body, places)
    shapes = shapely.convex_hull(shapely.linestrings(corners, indices=part_of))
    return Covered(shapes, np.array([around + part.spin * bulge(between) for part in body.parts]))


def _corners(body: Body, places: Array) -> tuple[Array, NDArray[np.int64]]:
    """The corners of all parts at places (N x 3), by corner of a part and then by place; of which part each is."""
    c, s = np.cos(places[:, 2, None]), np.sin(places[:, 2, None])
    px, py = np.concatenate([part.corners for part in body.parts]).T
    x, y = places[:, 0, None] + c * px - s * py, places[:, 1, None] + s * px + c * py
    part_of = np.repeat(np.arange(len(body.parts)), [len(part.corners) * len(places) for part in body.parts])
    return np.stack([x.T.ravel(), y.T.ravel()], axis=1), part_of


def bulge(between: float) -> float:
    """How far an arc is outside of straight lines between headings that are `between` [rad] off, in its radii."""
    return 1.0 - math.cos(min(between, math.pi))


def nearest(line: BaseGeometry, shape: BaseGeometry) -> tuple[float, float, float]:
    """How far a shape is from a line or an area [m], and the place there that is nearest to it."""
    way = shapely.shortest_line(line, shape)
    x, y = shapely.get_coordinates(way)[0]
    return float(way.length), float(x), float(y)
