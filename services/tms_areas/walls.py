"""The borders of where a machine may be, as walls for whoever searches a way: planners keep off, the law decides."""

import itertools

import shapely
from shapely import LineString, Polygon

from tms_areas.areas import AreaSet, Point

THICK = 3.0  # m beyond a border: no step of a search leads over it
SIMPLER = 0.2  # m that a wall may be off: fewer corners make a search faster


def walls(areas: AreaSet, held: frozenset[str] = frozenset()) -> list[tuple[Point, ...]]:
    """Polygons (corners [m] in `map`) along every border that a machine must not cross."""
    usable = areas.usable(held).simplify(SIMPLER)
    found = []
    for line in shapely.get_parts(usable.boundary):
        for side in itertools.pairwise(line.coords):
            beyond = LineString(side).buffer(THICK, quad_segs=1, cap_style="flat").difference(usable)
            found += [tuple(one.exterior.coords[:-1]) for one in shapely.get_parts(beyond) if isinstance(one, Polygon)]
    return found
