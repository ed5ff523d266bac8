"""Areas of a site: polygons in the frame `map`, in a set that never changes once it is enabled.

A machine may be where an unmanned area is and no restricted, manned or blocked one. A release area may be entered by
its holder alone. In a speed limit nobody is faster than it says; where several overlap, the least counts.
"""

import hashlib
import json
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

from shapely import Polygon
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

Kind = Literal["unmanned", "restricted", "manned", "blocked", "release", "speed_limit"]
OnLoss = Literal["stop", "evacuate"]  # what the holder of a release area does that it has lost
Point = tuple[float, float]  # x, y [m]

FORBIDDEN: tuple[Kind, ...] = ("restricted", "manned", "blocked")
DIGITS = 3  # of a corner in metres: the same file has the same set id on every PC
SHOWN = 8  # characters of a set id that people read


@dataclass(frozen=True)
class Area:
    """One area; `corners` [m, map] run counter-clockwise from the least one, and the last is not the first."""

    id: str
    kind: Kind
    corners: tuple[Point, ...]
    name: str = ""
    speed: float | None = None  # m/s, of a speed limit
    on_loss: OnLoss | None = None  # of a release area

    @cached_property
    def polygon(self) -> Polygon:
        return Polygon(self.corners)

    @property
    def properties(self) -> dict[str, Any]:
        """What GeoJSON tells of it besides its corners."""
        told = {"id": self.id, "type": self.kind, "name": self.name, "maximum_speed": self.speed}
        return {key: value for key, value in {**told, "on_loss": self.on_loss}.items() if value not in (None, "")}


@dataclass(frozen=True)
class AreaSet:
    """All areas of a site, by their ids."""

    areas: tuple[Area, ...]

    @cached_property
    def id(self) -> str:
        """SHA-256 of the content: a set that says anything else has another one."""
        content = [[one.properties, [[float(x), float(y)] for x, y in one.corners]] for one in self.areas]
        return hashlib.sha256(json.dumps(content, sort_keys=True, separators=(",", ":")).encode()).hexdigest()

    def of(self, *kinds: Kind) -> tuple[Area, ...]:
        """Its areas of some kinds."""
        return tuple(one for one in self.areas if one.kind in kinds)

    def usable(self, held: frozenset[str] = frozenset()) -> BaseGeometry:
        """Where a machine may be that holds the release areas `held`."""
        closed = [one.polygon for one in self.areas if one.kind in FORBIDDEN]
        closed += [one.polygon for one in self.of("release") if one.id not in held]
        return unary_union([one.polygon for one in self.of("unmanned")]).difference(unary_union(closed))


def ring(corners: list[Point]) -> tuple[Point, ...]:
    """The corners of an area as a set keeps them: rounded, none twice in a row, from the least one on, to the left."""
    rounded = [(round(x, DIGITS) + 0.0, round(y, DIGITS) + 0.0) for x, y in corners]
    apart = [here for before, here in zip([rounded[-1], *rounded], rounded, strict=False) if here != before]
    if len(apart) < 3:
        return tuple(apart)
    pairs = zip(apart, [*apart[1:], apart[0]], strict=True)
    if sum(a[0] * b[1] - b[0] * a[1] for a, b in pairs) < 0:
        apart.reverse()
    first = apart.index(min(apart))
    return (*apart[first:], *apart[:first])
