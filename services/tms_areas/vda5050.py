"""A set of areas as the message `zoneSet` of VDA 5050, version 3.0.0.

Its zones say where a robot must not be, ours where it may be: what lies around the unmanned areas becomes BLOCKED, cut
into simple polygons, as its zones have no holes. A restricted area is one that needs a release.
"""

from collections.abc import Iterator
from typing import Any

from shapely import Polygon, box
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from tms_areas.areas import Area, AreaSet, ring

VERSION = "3.0.0"
AROUND = 100.0  # m around the unmanned areas that become BLOCKED


def zone_set(areas: AreaSet, name: str, stamp: str) -> dict[str, Any]:
    """The message for the map of a site; `stamp`: now, by ISO 8601 in UTC. Whoever sends it fills in its robot."""
    zones = [_zone(one) for one in areas.areas if one.kind != "unmanned"]
    for number, part in enumerate(_outside(areas), 1):
        zones.append({"zoneId": f"outside:{number}", "zoneType": "BLOCKED", "vertices": _vertices(part)})
    header = {"headerId": 0, "timestamp": stamp, "version": VERSION, "manufacturer": "", "serialNumber": ""}
    told = {"mapId": name, "zoneSetId": areas.id, "zoneSetDescriptor": f"{name}: areas", "zones": zones}
    return {**header, "zoneSet": told}


def _zone(area: Area) -> dict[str, Any]:
    zone: dict[str, Any] = {"zoneId": area.id, "zoneType": "BLOCKED", "vertices": _vertices(area.polygon)}
    if area.name:
        zone["zoneDescriptor"] = area.name
    if area.kind == "speed_limit":
        return {**zone, "zoneType": "SPEED_LIMIT", "maximumSpeed": area.speed}
    if area.kind in ("release", "restricted"):
        return {**zone, "zoneType": "RELEASE", "releaseLossBehavior": (area.on_loss or "stop").upper()}
    return zone


def _outside(areas: AreaSet) -> Iterator[Polygon]:
    """What lies around the unmanned areas, as polygons without holes."""
    inside = unary_union([one.polygon for one in areas.of("unmanned")])
    yield from _simple(inside.envelope.buffer(AROUND, join_style="mitre").difference(inside))


def _simple(shape: BaseGeometry) -> Iterator[Polygon]:
    """The polygons of a shape, each with a hole cut upright through the middle of the hole."""
    for part in getattr(shape, "geoms", [shape]):
        if not isinstance(part, Polygon) or part.is_empty:
            continue  # a side on which two parts touch
        if not part.interiors:
            yield part
            continue
        x0, y0, x1, y1 = part.bounds
        middle = part.interiors[0].centroid.x
        yield from _simple(part.intersection(box(x0, y0, middle, y1)))
        yield from _simple(part.intersection(box(middle, y0, x1, y1)))


def _vertices(polygon: Polygon) -> list[dict[str, float]]:
    corners = ring([(x, y) for x, y in polygon.exterior.coords[:-1]])
    return [{"x": x, "y": y} for x, y in corners]
