"""The ground of a site with its machines: it takes what machines report, one report after another.

The same reports give the same ground, to the last bit.
"""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from tms_config.models import MachineModel
from tms_control.links import Links, Matrix
from tms_soil.digging import Digger
from tms_soil.driving import Grader, Rolling
from tms_soil.grid import Grid
from tms_soil.hauling import Hauler
from tms_soil.slumping import MARGIN, settle
from tms_soil.surface import Array, Bounds

STEP = 0.02  # s, longest step: a report after a longer time is taken in parts, straight from place to place
GAP = 1.0  # s without a report, after which nobody knows which way the machine took, where nothing else is said
JUMP = 1.0  # m in a short time that no machine makes: it was put somewhere else ...
FASTEST = 12.0  # m/s, ... and in a longer one: a bucket far out on an upper body that turns at 1.1 rad/s


class Body:
    """One machine's parts that touch soil, and where they were."""

    def __init__(self, model: MachineModel, grid: Grid) -> None:
        self.digger = Digger(model.bucket, grid) if model.bucket else None
        self.hauler = Hauler(model.vessel, grid) if model.vessel else None
        self.grader = Grader(model.blade, grid) if model.blade else None
        self.rolling = Rolling(model.tracks, grid) if model.tracks else None
        tools = {"digger": model.bucket, "hauler": model.vessel, "grader": model.blade}
        self._link = {part: tool.link for part, tool in tools.items() if tool}
        self._links = Links(model, self._link.values())
        self._known: tuple[Mapping[str, float], Matrix, dict[str, Matrix]] | None = None  # see `at`
        self.time = -math.inf  # s, of its last report
        self.places: dict[str, Matrix] = {}  # part -> its link in map, at the last report
        self.running: list[Bounds] = []  # where soil that it moved still runs
        self.rests = False  # nothing happened in its last step

    @property
    def stood(self) -> tuple[Mapping[str, float], Matrix] | None:
        """Joint angles [rad] and the place of base_link in map at the last report; None: there was none."""
        return None if self._known is None else self._known[:2]

    @property
    def load(self) -> Array | None:
        """Soil in its bucket or vessel [kg by soil]; None: it has neither."""
        part = self.digger or self.hauler
        return part.load if part else None

    @property
    def resistance(self) -> float:
        """Force of the soil against its bucket or blade [N]."""
        part = self.digger or self.grader
        return part.resistance if part else 0.0

    def at(self, angles: Mapping[str, float], base: Matrix) -> dict[str, Matrix]:
        """The links of its parts in map at joint angles [rad], with base_link at `base`.

        A machine that stands tells the same over and over; one with the same `base`, which nobody changes, is known.
        """
        if not self._link:
            return {"base": base}
        if self._known is None or self._known[1] is not base or self._known[0] != angles:
            pose = np.array([[angles.get(joint, 0.0) for joint in self._links.names]])
            links = self._links.places(pose)
            found = {"base": base} | {part: base @ links[link][0] for part, link in self._link.items()}
            self._known = dict(angles), base, found
        return self._known[2]

    def step(
        self, before: Mapping[str, Matrix], after: Mapping[str, Matrix], seconds: float, haulers: Sequence[Hauler]
    ) -> list[Bounds]:
        """Move its parts straight from places to places; returns where the ground changed."""
        changed: list[Bounds] = []
        if self.rolling:
            changed += self.rolling.step(after["base"])
        if self.grader:
            changed += self.grader.step(before["grader"], after["grader"])
        if self.hauler:
            changed += self.hauler.step(after["hauler"], seconds)
        if self.digger:
            changed += self.digger.step(before["digger"], after["digger"], seconds, haulers)
        return changed


class Earth:
    """The ground and all machines of a site."""

    def __init__(self, grid: Grid, models: Mapping[str, MachineModel], gap: float = GAP) -> None:
        """`models`: by machine; `gap`: s without a report, after which nobody knows which way a machine took."""
        self.grid, self._gap = grid, gap
        self.bodies = {name: Body(model, grid) for name, model in models.items()}
        self._haulers = [body.hauler for body in self.bodies.values() if body.hauler]

    def report(self, machine: str, time: float, angles: Mapping[str, float], base: Matrix) -> list[Bounds]:
        """Take joint angles [rad] and the place of base_link in map (4 x 4) of a machine at a time [s of its clock].

        Returns where the ground changed. A clock that goes back, a long silence and a jump are a new beginning: nobody
        knows what the machine did meanwhile, so it did nothing.
        """
        body = self.bodies[machine]
        now, seconds = body.at(angles, base), time - body.time
        before = body.places if 0 <= seconds <= self._gap and _near(body.places, now, seconds) else now
        still = before is now or all(np.array_equal(before[part], now[part]) for part in now)
        body.places, body.time = now, time
        if still and body.rests and not body.running:
            return []
        changed, count = [], max(1, math.ceil(min(seconds, self._gap) / STEP - 1e-6))
        for k in range(count):
            here, there = (_between(before, now, one / count) for one in (k, k + 1))
            found = body.step(here, there, min(max(seconds, 0.0), self._gap) / count, self._haulers)
            body.rests = still and not found and seconds > 0.0
            places = body.running + found
            body.running = self._settle(places)
            changed += [_with_margin(one) for one in places]
        return changed

    def mass(self) -> float:
        """All soil [kg]: of the ground, beside the site, and in buckets and vessels."""
        loads = [float(body.load.sum()) for body in self.bodies.values() if body.load is not None]
        return math.fsum((self.grid.mass(), self.grid.outside, *loads))

    def _settle(self, places: list[Bounds]) -> list[Bounds]:
        """Let slopes give way at some places; returns where soil still runs."""
        found = []
        for place in _apart(places):
            window = self.grid.window(_with_margin(place))
            if window is not None:
                if (still := settle(window)) is not None:
                    found.append(still)
                self.grid.store(window)
        return found


def _near(before: Mapping[str, Matrix], now: Mapping[str, Matrix], seconds: float) -> bool:
    far = max(JUMP, FASTEST * seconds)
    return before.keys() == now.keys() and all(math.dist(before[k][:3, 3], now[k][:3, 3]) < far for k in now)


def _between(before: Mapping[str, Matrix], now: Mapping[str, Matrix], share: float) -> Mapping[str, Matrix]:
    if share == 1.0 or before is now:
        return now
    return {part: before[part] + share * (now[part] - before[part]) for part in now}


def _apart(places: list[Bounds]) -> list[Bounds]:
    """Rectangles that do not touch, each around some of the given ones."""
    found: list[Bounds] = []
    for one in places:
        while other := next((two for two in found if _touch(one, two)), None):
            found.remove(other)
            (a, b, c, d), (e, f, g, h) = one, other
            one = min(a, e), min(b, f), max(c, g), max(d, h)
        found.append(one)
    return found


def _with_margin(place: Bounds) -> Bounds:
    return place[0] - MARGIN, place[1] - MARGIN, place[2] + MARGIN, place[3] + MARGIN


def _touch(a: Bounds, b: Bounds) -> bool:
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]
