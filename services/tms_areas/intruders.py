"""Who is where no person may be, by what trackers have told and how old that is; and what follows for one machine.

Somebody inside stops and latches; so does a gate that was opened, until a person has looked. A tracker that is silent,
or tells what makes no sense, counts as somebody inside, unless its settings say otherwise.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tms_areas.areas import Point
from tms_areas.reasons import (
    APerson,
    AVehicle,
    GateOpened,
    IntruderInside,
    IntruderNear,
    TrackerSilent,
    TrackerUnheard,
    TrackerUnreadable,
)
from tms_areas.trackers import Tracker
from tms_areas.zones import Array, Zones
from tms_reason.reason import Reason

NOBODY = np.zeros((0, 2))


@dataclass(frozen=True)
class Danger:
    """What people and trackers mean for one machine now."""

    stop: Reason | None = None  # and latch
    hold: Reason | None = None  # until it passes
    warn: Reason | None = None  # go slowly
    passed: Reason | None = None  # and latch: a gate was open, and no person has looked since

    @property
    def present(self) -> Reason | None:
        """Why nothing may begin to move, and no person may arm the machine."""
        return self.stop or self.hold


@dataclass
class Told:
    """What one tracker has told. Times are of one monotonic clock [s]."""

    given: Tracker
    since: float  # when somebody began to listen, or when its newest message was measured
    heard: bool = False
    wrong: Reason | None = None  # why its last message cannot be read
    places: Array = field(default_factory=lambda: NOBODY)
    opened: bool = False  # of a gate, now
    passed: bool = False  # of a gate, since a person has looked


class Intruders:
    """Keeps what the trackers of a site have told. Not for several threads."""

    def __init__(self, trackers: Mapping[str, Tracker], now: float) -> None:
        self.told = {name: Told(given, now) for name, given in trackers.items()}
        self.openings = 0  # of gates so far

    def seen(self, tracker: str, measured: float, places: Sequence[Point]) -> None:
        """Take where people or vehicles were at a time [m, map]; an older message than the last one is no news."""
        if (one := self._news(tracker, measured)) is not None:
            one.places = np.array(places, dtype=float).reshape(-1, 2)

    def gate(self, tracker: str, measured: float, value: bool) -> None:
        """Take what a gate says; that it was opened counts however late it comes."""
        one = self.told[tracker]
        opened = value == one.given.opened
        self.openings += opened and not one.opened
        one.passed |= opened
        if self._news(tracker, measured) is not None:
            one.opened = opened

    def unreadable(self, tracker: str, why: Reason) -> None:
        """Take a message that says nothing: as long as no other one comes, the tracker counts as silent."""
        self.told[tracker].wrong = why

    def looked(self) -> None:
        """A person has armed the machine, who had to look who came in."""
        for one in self.told.values():
            one.passed = False

    def look(self, now: float, zones: Zones, machine: str, here: Point | None) -> Danger:
        """What follows for a machine that is at a place [m, map]; None: nobody knows where it is."""
        every = []
        for name, one in self.told.items():
            if one.given.areas and not any(zones.share(area, here) for area in one.given.areas):
                continue
            every.append(_danger(name, one, now, zones, machine, here))
        return Danger(*(_first(every, what) for what in ("stop", "hold", "warn", "passed")))

    def _news(self, tracker: str, measured: float) -> Told | None:
        one = self.told[tracker]
        if one.heard and measured < one.since:
            return None
        one.since, one.heard, one.wrong = measured, True, None
        return one


def _danger(name: str, one: Told, now: float, zones: Zones, machine: str, here: Point | None) -> Danger:
    opened = GateOpened(machine, name, one.given.areas) if one.passed or one.opened else None
    if one.opened:
        return Danger(stop=opened, passed=opened)
    return replace(_by_places(name, one, max(0.0, now - one.since), zones, machine, here), passed=opened)


def _by_places(name: str, one: Told, age: float, zones: Zones, machine: str, here: Point | None) -> Danger:
    if one.wrong is not None:
        return _silent(one.given, TrackerUnreadable(name, one.wrong))
    if age > one.given.silent_after:
        return _silent(one.given, TrackerSilent(name, age))
    if not one.heard:
        return Danger(hold=TrackerUnheard(name))
    if (who := zones.found(one.places, one.given.around(age), here)) is None:
        return Danger()
    what = APerson() if one.given.kind == "person" else AVehicle()
    if who.inside:
        return Danger(stop=IntruderInside(machine, what, who.area, name, who.x, who.y))
    return Danger(warn=IntruderNear(machine, what, who.area, name, who.x, who.y))


def _silent(given: Tracker, why: Reason) -> Danger:
    if given.on_silence == "stop":
        return Danger(stop=why)
    return Danger(hold=why) if given.on_silence == "hold" else Danger(warn=why)


def _first(every: Sequence[Danger], what: str) -> Reason | None:
    return next((found for one in every if (found := getattr(one, what)) is not None), None)
