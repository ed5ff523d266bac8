"""One seeded history of people who walk among machines, of trackers that see them, and of a gateway that hears these.

Truth: from 0.2 s after the first message that was measured since somebody is inside has come, nothing commands a
motion; nor from 0.2 s after a tracker has been silent for too long. Who is inside is told by truth.py.
"""

import math
import random
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np

from areas.truth import Array, inside
from tms_areas.areas import Area, AreaSet, Point, ring
from tms_areas.intruders import Intruders
from tms_areas.trackers import Tracker
from tms_areas.zones import Zones
from tms_rc.intruder_watch import PERIOD
from tms_rc.latch_order import LatchOrder

SECONDS = 60.0  # of a history
STEP = 0.02  # s
LIMIT = 0.2  # s from a message to the last command that moves
LINK = 0.08  # s at most from an order to the command at the machine
RATE = 0.1  # s between messages of a tracker
LOOKS_ROUND = 3.0  # s until a person who sees the area free re-arms
SLOWEST, FASTEST = 0.5, 1.6  # m/s, of people


@dataclass
class Walker:
    """Somebody who walks from one place to the next, and turns round at times."""

    random: random.Random
    x: float
    y: float
    goal: Point = (0.0, 0.0)
    speed: float = 0.0

    def step(self) -> None:
        way = math.dist((self.x, self.y), self.goal)
        if way < 0.1 or self.random.random() < 0.002:
            far = self.random.choice([15, 45])
            self.goal = self.random.uniform(-far, far), self.random.uniform(-far, far)
            self.speed = self.random.uniform(SLOWEST, FASTEST)
            return
        share = min(1.0, self.speed * STEP / way)
        self.x, self.y = self.x + share * (self.goal[0] - self.x), self.y + share * (self.goal[1] - self.y)


@dataclass
class Eye:
    """A tracker: late, lost and overtaken messages, and times without any."""

    random: random.Random
    delay: float
    loss: float
    silences: list[tuple[float, float]]
    next: float = 0.0
    coming: list[tuple[float, float, list[Point]]] = field(default_factory=list)  # arrives, measured, places

    def look(self, now: float, walkers: list[Walker]) -> None:
        if now < self.next:
            return
        self.next = now + RATE * self.random.uniform(0.8, 1.2)
        if self.random.random() < self.loss or any(a <= now < b for a, b in self.silences):
            return
        arrives = now + self.random.uniform(0.0, self.delay)
        self.coming.append((arrives, now, [(one.x, one.y) for one in walkers]))

    def arrived(self, now: float) -> list[tuple[float, float, list[Point]]]:
        found = sorted(one for one in self.coming if one[0] <= now)
        self.coming = [one for one in self.coming if one[0] > now]
        return found


@dataclass
class Seen:
    """What a history has shown."""

    seed: int
    moved: str = ""  # when something moved that must not
    stops: int = 0
    rearms: int = 0
    entered: int = 0  # times that somebody came in
    worst: float = 0.0  # s from a message to the last command


def run(seed: int) -> Seen:
    """The history of a seed."""
    r, out = random.Random(seed), Seen(seed)
    areas, open_ones, closed = _areas(r)
    here = (0.0, 0.0)
    walkers = [Walker(random.Random(seed + k), r.uniform(-45, 45), r.uniform(-45, 45)) for k in range(r.choice([1, 2]))]
    silences = [(at, at + r.uniform(0.5, 15.0)) for at in (r.uniform(2, SECONDS) for _ in range(r.choice([0, 1, 4])))]
    eye = Eye(random.Random(seed + 9), r.choice([0.05, 0.3, 0.8]), r.choice([0.0, 0.1, 0.5]), silences)
    given = Tracker(kind="person", topic="eye", silent_after=1.5)
    site, zones = Intruders({"eye": given}, 0.0), Zones(areas)
    gateway: Any = SimpleNamespace(latch=SimpleNamespace(cause=None), by_hand=None)
    asked: list[object] = []
    order = LatchOrder(gateway, asked.append)
    moves_until, next_look, free_since = math.inf, 0.0, math.inf
    since: float | None = None  # somebody is inside
    told: float | None = None  # when the first message came that was measured since then
    newest = 0.0  # when the newest message was measured
    for step in range(round(SECONDS / STEP)):
        now = step * STEP
        for one in walkers:
            one.step()
        if _inside(walkers, open_ones, closed):
            out.entered += since is None
            since = now if since is None else since
        else:
            since = told = None
        eye.look(now, walkers)
        for _, measured, places in eye.arrived(now):
            site.seen("eye", measured, places)
            newest = max(newest, measured)
            if since is not None and told is None and measured >= since:
                told = now
        if now >= next_look:
            next_look = now + PERIOD * r.uniform(0.8, 1.5)
            danger = site.look(now, zones, "machine", here)
            if order.armed():
                site.looked()
            order.give(now, danger.stop)
            if asked:
                gateway.latch.cause = asked.pop()
                out.stops += 1
                moves_until = now + r.uniform(0.02, LINK)
            free_since = math.inf if danger.present else min(free_since, now)
            if gateway.latch.cause is not None and now - free_since > LOOKS_ROUND:
                gateway.latch.cause, moves_until = None, math.inf
                out.rearms += 1
        if now > moves_until:
            continue
        due = newest + given.silent_after if now > newest + given.silent_after else math.inf
        due = min(due, told) if told is not None else due
        if due < now:
            out.worst = max(out.worst, now - due)
        if now - due > LIMIT:
            out.moved = f"{now:.2f} s, due since {due:.2f} s"
            break
    return out


def _inside(walkers: list[Walker], open_ones: list[Array], closed: list[Array]) -> bool:
    at = np.array([(one.x, one.y) for one in walkers])
    within = np.zeros(len(at), dtype=bool)
    for polygon in open_ones:
        within |= inside(at, polygon)
    for polygon in closed:
        within &= ~inside(at, polygon)
    return bool(within.any())


def _areas(r: random.Random) -> tuple[AreaSet, list[Array], list[Array]]:
    """Two unmanned areas round the machine that overlap, a manned hut inside, a restricted area beside."""
    found = []
    for number in range(2):
        count = r.randint(5, 12)
        turns = [(math.tau * k / count, r.uniform(14, 25)) for k in range(count)]
        corners = [(number * 4 + d * math.cos(t), d * math.sin(t)) for t, d in turns]
        found.append(Area(f"u{number}", "unmanned", ring(corners)))
    x, y, size = r.uniform(2, 6), r.uniform(2, 6), r.uniform(1, 3)
    found.append(Area("hut", "manned", ring([(x, y), (x + size, y), (x + size, y + size), (x, y + size)])))
    found.append(Area("fence", "restricted", ring([(-50, 30), (50, 30), (50, 35), (-50, 35)])))
    shapes = [np.array(one.corners) for one in found]
    return AreaSet(tuple(found)), shapes[:2], shapes[2:]
