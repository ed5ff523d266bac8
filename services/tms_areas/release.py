"""Release areas of one machine: where it is, where it may come to be, and which of them a goal needs."""

import itertools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import shapely

from tms_areas.areas import Area, Point
from tms_areas.body import Body
from tms_areas.fix import WINDOW, Seen
from tms_areas.law import Law
from tms_areas.reach import Covered
from tms_areas.reasons import EntersArea, NoWay
from tms_reason.reason import Reason


def touched(covered: Covered, areas: Iterable[Area]) -> frozenset[str]:
    """The areas in which a part of a machine may be."""
    return frozenset(area.id for area in areas if covered.touches(area))


@dataclass
class Presence:
    """Where a machine is among areas, and where it may still come to be, whatever it is told now."""

    inside: frozenset[str] = frozenset()  # where it is, or was last
    near: frozenset[str] = frozenset()  # where it is, or may come until it stands
    drove: float = float("-inf")  # monotonic [s], when a goal last drove it

    def look(self, law: Law, body: Body, seen: Seen, areas: Iterable[Area], drives: bool, now: float) -> None:
        """Where it is by one look; `drives`: a goal does.

        A goal that is over may have told the tracks what they have not begun yet, so a machine that is seen to stand
        is taken to only when that would have shown.
        """
        if drives:
            self.drove = now
        if (motion := seen.motion) is None:
            return
        if seen.unsure is None:
            self.inside = touched(law.now(body, motion), areas)
        stands = motion.rests and now - self.drove > law.blind + WINDOW
        self.near = self.inside | (frozenset() if stands else touched(law.until_it_stands(body, motion), areas))


def straight(areas: Iterable[Area], points: Sequence[Point], around: float) -> frozenset[str]:
    """The areas that come nearer than `around` [m] to the straight lines through some points [m, map]."""
    line = shapely.linestrings(points) if len(set(points)) > 1 else shapely.Point(points[0])
    return frozenset(area.id for area in areas if shapely.dwithin(area.polygon, line, around))


def needed(
    areas: Iterable[Area], likely: frozenset[str], may: Callable[[frozenset[str]], Reason | None]
) -> tuple[frozenset[str], Reason | None]:
    """Which areas a goal needs, and why it would be refused even with these.

    `may`: why a goal is refused to the holder of some areas; `likely`: those that it needs anyhow, as nobody knows
    which way a planner will choose. Where no way is open, all are tried, and those are left out that open none.
    """
    names = frozenset(area.id for area in areas)
    found = likely
    while (wrong := may(found)) is not None:
        entered = wrong.find(EntersArea)
        if entered is not None and entered.area in names - found:
            found |= {entered.area}
        elif wrong.find(NoWay) is not None and found != names:
            found = names
        else:
            return found, wrong
    for one in sorted(found - likely):
        if may(found - {one}) is None:
            found -= {one}
    return found, None


def corners_of(here: tuple[float, float, float], way: Sequence[tuple[float, float, float]]) -> list[Point]:
    """The points of a way from where a machine is, none twice in a row."""
    points = [(x, y) for x, y, _ in (here, *way)]
    return [points[0], *(new for old, new in itertools.pairwise(points) if new != old)]
