"""How two sets of areas differ."""

from dataclasses import dataclass

from shapely import Polygon

from tms_areas.areas import AreaSet


@dataclass(frozen=True)
class Change:
    """What one set says of an area otherwise than another one."""

    id: str
    kind: str  # added, removed, changed
    before: float  # m2
    after: float  # m2
    away: float  # m2 that only the one before covers
    new: float  # m2 that only the one after covers


def changes(before: AreaSet | None, after: AreaSet) -> list[Change]:
    """Which areas differ."""
    old = {} if before is None else {one.id: one for one in before.areas}
    new = {one.id: one for one in after.areas}
    found = []
    for name in sorted({*old, *new}):
        was, now = old.get(name), new.get(name)
        if was == now:
            continue
        kind = "added" if was is None else "removed" if now is None else "changed"
        a, b = (Polygon() if one is None else one.polygon for one in (was, now))
        found.append(Change(name, kind, a.area, b.area, a.difference(b).area, b.difference(a).area))
    return found
