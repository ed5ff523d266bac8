"""What machines did while nobody looked, as far as it follows from how they stood before and after.

- A machine that carries soil has gone straight from there to here, in the time that it took. One that was in the ground
  has curled its bucket first, and then lifted and swung it, as digs do.
- A bucket that held soil and cannot hold it now was emptied: into the carrier in reach, if there is one.

Both are estimates. What came and went in between is not known.
"""

import math
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from tms_control.links import Matrix
from tms_soil.digging import Digger
from tms_soil.earth import JUMP, Body, Earth
from tms_soil.hauling import Hauler
from tms_soil.surface import Array, Bounds

LONGEST = 60.0  # s of a machine, in which it fills and empties a bucket twice at most
STEP = 0.2  # s between two places on the way
HOLDS = 0.5  # of its load: a bucket that is tilted so that it holds less was emptied
LIFTS = ("swing_joint", "boom_joint")  # what brings a bucket up and away
BESIDE = 3.0  # m from where its lip was to the middle of a vessel: about the half of one


class Missed(NamedTuple):
    """What happened meanwhile."""

    changed: list[Bounds]  # where the ground changed
    into: str = ""  # carrier that a bucket was emptied into


def miss(earth: Earth, machine: str, seconds: float, angles: Mapping[str, float], base: Matrix) -> Missed:
    """Let a machine come to joint angles [rad] and a place of base_link, where it is after an absence of ours.

    `seconds` [s of the machine]: how long that was. Its next report goes on from there.
    """
    body = earth.bodies[machine]
    known = body.stood
    if known is None or not 0.0 < seconds <= LONGEST or _moved(known[1], base) or not _works(body):
        return Missed([])
    before, stood = known
    place = body.at(angles, stood).get("digger")
    if body.digger is not None and place is not None and (into := _emptied(earth, body, body.digger, place)):
        return Missed(_pour(earth, body.digger, into), into)
    dug, begun, changed = body.resistance > 0.0, body.time, list[Bounds]()
    for k in range(1, (count := math.ceil(seconds / STEP)) + 1):
        pose = _way(before, angles, dug, k / count)
        changed += earth.report(machine, begun + k / count * seconds, pose, stood)
    return Missed(changed)


def _way(before: Mapping[str, float], now: Mapping[str, float], dug: bool, share: float) -> dict[str, float]:
    """Joint angles [rad] at a share of the time."""
    first, second = (min(1.0, 2 * share), max(0.0, 2 * share - 1)) if dug else (share, share)
    return {
        name: angle + (second if name in LIFTS else first) * (now.get(name, angle) - angle)
        for name, angle in before.items()
    }


def _moved(before: Matrix, now: Matrix) -> bool:
    return math.dist(before[:3, 3], now[:3, 3]) > JUMP


def _works(body: Body) -> bool:
    return body.resistance > 0.0 or (body.load is not None and bool(body.load.any()))


def _emptied(earth: Earth, body: Body, digger: Digger, place: Matrix) -> str:
    """The carrier that the bucket was emptied into; empty: none, or it is still above one."""
    haulers = [(name, one.hauler) for name, one in earth.bodies.items() if one.hauler is not None]
    lip = digger.lip(place)
    if digger.holds(place) > HOLDS * digger.volume or any(one.below(lip) > 0.0 for _, one in haulers):
        return ""
    base, was = body.places["base"][:2, 3], digger.lip(body.places["digger"]).mean(axis=0)[:2]
    return _nearest(haulers, base, max(math.dist(base, was), math.dist(base, lip.mean(axis=0)[:2])) + BESIDE)


def _nearest(haulers: Iterable[tuple[str, Hauler]], base: Array, reach: float) -> str:
    """The carrier whose vessel is nearest; empty: none is within `reach` [m]."""
    away = [(math.dist(base, one.middle[:2]), name) for name, one in haulers if one.middle is not None]
    far, name = min(away, default=(math.inf, ""))
    return name if far <= reach else ""


def _pour(earth: Earth, digger: Digger, into: str) -> list[Bounds]:
    hauler = earth.bodies[into].hauler
    assert hauler is not None and hauler.middle is not None
    soil = digger.load.copy()
    digger.load[:] = 0.0
    return hauler.take(soil, hauler.middle)
