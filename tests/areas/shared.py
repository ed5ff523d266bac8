"""One seeded history of machines that share places, in virtual time: keeper, gateways, schedulers, people and losses.

Messages are late and get lost; keeper, gateways and schedulers are restarted; writes to the store fail. Which machine
truly is in which place is judged by other geometry code, who waits for whom by other graph code.
"""

import heapq
import itertools
import math
import random
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from areas.history import Outline
from areas.plant import STEP, Ground, Localisation, Plant, Trouble
from areas.truth import Array, edge, inside
from tms_areas.areas import Area, AreaSet, ring
from tms_areas.braking import Axis, Tracks
from tms_areas.fix import Fix, Seen
from tms_areas.guard import Guard
from tms_areas.law import Law, Place
from tms_areas.release import Presence, needed
from tms_places.claims import Book, of_document, to_document
from tms_places.keeper import Keeper, Leases
from tms_places.leases import PERIOD, OwnLeases
from tms_places.reasons import WaitingCircle
from tms_places.telling import alarms
from tms_reason.errors import TmsError

SECONDS = 150.0  # of a history ...
QUIET = 100.0  # ... of which the last part has no new losses
LOOK = 0.1  # s between looks of a gateway
AGAIN = 1.0  # s after which a message is sent again
UNSEEN = 4.0  # s that a circle of machines may stay untold, while the keeper lives
ENDS = 32.0  # m, where machines turn round
LANES = (-8.0, 0.0, 8.0)  # m; they never meet, but places are as wide as the road
TRACKS = Tracks(Axis(3.0, 1.0, 0.3), Axis(0.5, 0.5, 0.3), 0.3)


@dataclass
class Result:
    """What a history has shown."""

    seed: int
    two_inside: str = ""  # in which place two machines truly were, and when
    unseen: str = ""  # machines that waited in a circle, untold
    starved: str = ""  # who waited at the end for a place that nobody had
    rounds: int = 0
    circles: int = 0
    stops: int = 0
    held: int = 0
    revoked: int = 0


class World:
    """Time, messages, and what breaks."""

    def __init__(self, seed: int) -> None:
        self.random, self.now = random.Random(seed), 0.0
        self._coming: list[tuple[float, int, Callable[[], None]]] = []
        self._number = itertools.count()

    def after(self, seconds: float, act: Callable[[], None]) -> None:
        heapq.heappush(self._coming, (self.now + seconds, next(self._number), act))

    def send(self, act: Callable[[], None]) -> None:
        """A message: late, very late, or lost."""
        lossy = self.now < QUIET
        if not (lossy and self.random.random() < 0.15):
            late = lossy and self.random.random() < 0.1
            self.after(self.random.uniform(0.005, 3.0 if late else 0.1), act)

    def step(self) -> None:
        self.now += STEP
        while self._coming and self._coming[0][0] <= self.now:
            heapq.heappop(self._coming)[2]()


class Store:
    """Keeps the book of a keeper that dies, and refuses some writes."""

    def __init__(self, world: World, machines: list[str]) -> None:
        self._world, self._machines = world, machines
        self._kept = to_document(Book())
        self.keeper: Keeper | None = Keeper(machines, Book(), 0.0)

    def change(self, act: Callable[[Keeper], None]) -> bool:
        """As tms:db does: what could not be written did not happen."""
        if (keeper := self.keeper) is None:
            return False
        before = keeper.book
        try:
            act(keeper)
            keeper.grant(self._world.now, self._world.now)
        except TmsError:
            keeper.book = before
            return False
        if keeper.book != before and self._world.now < QUIET and self._world.random.random() < 0.1:
            keeper.book = before
            return False
        self._kept = to_document(keeper.book)
        return True

    def die(self, seconds: float) -> None:
        self.keeper = None

        def back() -> None:
            self.keeper = Keeper(self._machines, of_document(self._kept), self._world.now)

        self._world.after(seconds, back)


@dataclass
class Machine:
    """A machine, its gateway, and the run that drives it to and fro."""

    name: str
    world: World
    store: Store
    areas: AreaSet
    corners: Array
    plant: Plant
    told: Localisation
    own: OwnLeases
    result: Result
    by_node: bool  # its tree holds places one after the other; else each goal asks for what it needs
    fix: Fix = field(default_factory=lambda: Fix(TRACKS.turning.top))
    goal: float = ENDS
    wants: list[str] = field(default_factory=list)  # in the order in which it asks
    asked: bool = False
    going: bool = False
    latched: bool = False
    dead_until: float = 0.0
    there: Presence = field(default_factory=Presence)
    seen: Seen = field(default_factory=lambda: Seen(None, None))
    due: float = 0.0
    speed: float = 0.0
    outline: Array = field(default_factory=lambda: np.zeros((0, 2)))
    guards: dict[frozenset[str], Guard] = field(default_factory=dict)

    def guard(self, held: frozenset[str]) -> Guard:
        if held not in self.guards:
            self.guards[held] = Guard(Law(self.areas, self.name, TRACKS, held), Outline(self.corners))
        return self.guards[held]

    # the gateway

    def report(self) -> None:
        now = self.world.now
        self.due = now + PERIOD
        names = [one.id for one in self.areas.of("release")]
        told = self.own.report(int(now * 1e9), names, self.there.inside, self.seen.unsure is None, now)
        own = self.own

        def arrive() -> None:
            kept = self.store.change(lambda keeper: keeper.report(told, self.world.now, self.world.now))
            if self.store.keeper is not None and (kept or self.store.keeper is not None):
                answer = self.store.keeper.leases(self.name)
                self.world.send(lambda: self.answered(own, told.number, answer))

        self.world.send(arrive)

    def answered(self, own: OwnLeases, number: int, answer: Leases) -> None:
        before = own.using
        own.answered(number, answer, self.there.inside)
        if own is self.own and own.using != before:
            self.due = min(self.due, self.world.now + 0.3)

    def look(self) -> None:
        now, place = self.world.now, (self.plant.x, self.plant.y, self.plant.yaw)
        for at, pose in self.told.take(now, place):
            self.fix.heard(at, *pose)
        self.fix.odometry(self.plant.v, self.plant.w)
        self.seen = self.fix.look(now)
        guard, body = self.guard(self.own.open), Outline(self.corners).body(())
        self.there.look(guard.law, body, self.seen, self.areas.of("release"), self.going, now)
        before = self.own.using
        self.own.give_back(self.there.near, self.seen.unsure is None, self.going)
        if self.own.using != before:
            guard, self.due = self.guard(self.own.open), now
        if self.going and self.seen.motion is not None:
            verdict = guard.look(self.seen, {}, tracks=True)
            over = (self.own.lost(now) - self.own.evacuates) & self.there.near
            if verdict.stop is not None:
                self.latched, self.result.stops = True, self.result.stops + 1
                self.world.after(6.0, self.rearm)
            self.result.held += bool(verdict.hold or over)
            if verdict.stop or verdict.hold or over:
                self.going = False
        if now >= self.due:
            self.report()

    def rearm(self) -> None:
        self.latched = False

    def restart(self) -> None:
        """The gateway is killed: its host agent stops the machine, and a new one knows nothing."""
        self.dead_until, self.going = self.world.now + self.world.random.uniform(1.0, 6.0), False
        self.own, self.fix = OwnLeases(self.name, self.own.evacuates), Fix(TRACKS.turning.top)
        self.seen, self.there, self.due = Seen(None, None), Presence(), 0.0

    # the run

    def drive(self) -> None:
        """Ask for what the next drive needs, begin it, and free all at its end."""
        if self.going or self.latched or self.seen.motion is None or self.seen.unsure is not None:
            return
        motion, now = self.seen.motion, self.world.now
        if abs(motion.x - self.goal) < 1.0:
            self.goal, self.result.rounds = -self.goal, self.result.rounds + 1
            self.give_up()
            return
        way: list[Place] = [(self.goal, self.plant.y, 0.0)]
        usable = self.own.open - (self.own.lost(now) - self.there.inside)
        if self.there.inside & self.own.lost(now):
            return
        if not self.asked and not self.wants:
            names, why = needed(
                self.areas.of("release"), frozenset(),
                lambda more: self.guard(usable | more).may_drive(self.seen, {}, way, told=True),
            )  # fmt: skip
            if why is not None:
                return
            self.wants = sorted(names, reverse=self.world.random.random() < 0.5)
        missing = [one for one in self.wants if one not in self.own.held(now)]
        if missing:
            self.ask(missing[:1] if self.by_node else self.wants)
        elif self.guard(usable).may_drive(self.seen, {}, way, told=True) is None:
            self.going = True
        elif not self.own.held(now) >= frozenset(self.wants) or not self.wants:
            self.wants, self.asked = [], False
        else:
            self.give_up()  # it needs others than it thought, from where it is now

    def ask(self, places: list[str]) -> None:
        if self.asked:
            return
        self.asked = True

        def arrive() -> None:
            self.store.change(lambda keeper: keeper.hold(self.name, "run", places, self.world.now))

        self.world.send(arrive)
        self.world.after(AGAIN, self.ask_again)

    def ask_again(self) -> None:
        self.asked = False

    def give_up(self) -> None:
        """The run wants nothing any more: told until it is heard."""
        self.wants, self.going = [], False
        if not self.store.change(lambda keeper: keeper.free(self.name, "", ()) or keeper.free(self.name, "run", ())):
            self.world.after(AGAIN, self.give_up)

    def steer(self) -> None:
        left, most = self.goal - self.plant.x, TRACKS.forward.top * 0.9
        wish = math.copysign(min(most, math.sqrt(2 * 0.6 * max(abs(left) - 0.5, 0.0))), left) if self.going else 0.0
        if self.going and abs(left) < 0.9:
            self.going = False
        change = TRACKS.forward.acceleration * LOOK
        self.speed = self.speed + max(-change, min(change, wish - self.speed)) if self.going else 0.0
        self.plant.command(self.speed, 0.0, 0.02)


def run(seed: int, jealous: bool = True) -> Result:
    """The history of a seed; not `jealous`: gateways believe that all places are theirs."""
    world, result = World(seed), Result(seed)
    machines, areas = _made(world, result)
    shapes = {one.id: np.array(one.corners) for one in areas.of("release")}
    circle_since: dict[tuple[str, ...], float] = {}
    for step in range(round(SECONDS / STEP)):
        world.step()
        for machine in machines:
            machine.plant.step()
        if step % round(LOOK / STEP):
            continue
        for machine in machines:
            if world.now < machine.dead_until:
                machine.plant.command(0.0, 0.0, 0.02)
                continue
            if not jealous:
                machine.own.until = dict.fromkeys(shapes, math.inf)
            machine.look()
            machine.drive()
            machine.steer()
        if result.two_inside or result.unseen:
            break
        _judge(world, machines, shapes, result, circle_since)
    keeper = machines[0].store.keeper
    if keeper is not None:
        stale = [one for one in keeper.book.queue if world.now - one.since > 30.0]
        open_ = [one for one in stale if not any(place in keeper.book.claims for place in one.places)]
        first = {place: one for one in reversed(keeper.book.queue) for place in one.places}
        result.starved = " ".join(one.machine for one in open_ if all(first[place] is one for place in one.places))
    return result


def _judge(
    world: World, machines: list[Machine], shapes: dict[str, Array], result: Result,
    since: dict[tuple[str, ...], float],
) -> None:  # fmt: skip
    """Two machines truly in one place; machines that wait in a circle and nobody is told."""
    for place, shape in shapes.items():
        there = [
            one.name for one in machines if inside(one.outline + np.array([one.plant.x, one.plant.y]), shape).any()
        ]
        if len(there) > 1:
            result.two_inside = f"{place} {there} at {world.now:.1f} s"
    keeper = machines[0].store.keeper
    stuck = () if keeper is None else _stuck(keeper)
    for old in [one for one in since if one != stuck]:
        del since[old]
    if not stuck or keeper is None:
        return
    since.setdefault(stuck, world.now)
    told = {name for why in alarms(keeper) if isinstance(why, WaitingCircle) for name in why.circle}
    if world.now - since[stuck] > UNSEEN and not told & set(stuck):
        result.unseen = f"{stuck} at {world.now:.1f} s"
    if world.now - since[stuck] > UNSEEN:  # a person cancels one of the runs
        result.circles += 1
        next(one for one in machines if one.name in stuck).give_up()
        since.clear()


def _stuck(keeper: Keeper) -> tuple[str, ...]:
    """Machines that can never go on: by taking out, again and again, those whose wishes the others leave open."""
    wants: dict[str, set[str]] = {}
    for one in keeper.book.queue:
        wants.setdefault(one.machine, set()).update(one.places)
    has = {name: {place for place, claim in keeper.book.claims.items() if claim.machine == name} for name in wants}
    left = set(wants)
    while free := {name for name in left if not any((wants[name] - has[name]) & has[other] for other in left - {name})}:
        left -= free
    return tuple(sorted(left))


def _made(world: World, result: Result) -> tuple[list[Machine], AreaSet]:
    """A road with places across it, two or three machines, and what befalls them."""
    r = world.random
    found = [Area("road", "unmanned", ring([(-60, -15), (60, -15), (60, 15), (-60, 15)]))]
    x = -17.0
    for number in range(r.choice([1, 2, 2, 3])):
        wide = r.uniform(4.0, 9.0)
        loss = r.choice(["stop", "evacuate"])
        corners = ring([(x, -14), (x + wide, -14), (x + wide, 14), (x, 14)])
        found.append(Area(f"p{number}", "release", corners, on_loss=loss))  # type: ignore[arg-type]
        x += wide + r.choice([-2.0, 1.0, 6.0])  # some overlap
    areas = AreaSet(tuple(found))
    corners = np.array([(-2.5, -1.5), (2.5, -1.5), (2.5, 1.5), (-2.5, 1.5)])
    names = [f"m{number}" for number in range(r.choice([2, 3]))]
    store, evacuates = Store(world, names), frozenset(one.id for one in found if one.on_loss == "evacuate")
    machines = []
    for number, name in enumerate(names):
        start = r.choice([-ENDS, ENDS])
        troubles = [Trouble("lost", at, at + r.uniform(0.5, 4.0), 0.0, 0.0, 0.0)
                    for at in (r.uniform(5, QUIET) for _ in range(r.choice([0, 0, 1, 2])))]  # fmt: skip
        plant = Plant(Ground(random.Random(r.random())), 0.1, TRACKS.dead_time, 0.3, start, LANES[number])
        told = Localisation(random.Random(r.random()), 0.08, 0.1, 0.005, 0.05, troubles, 0.0)
        one = Machine(name, world, store, areas, corners, plant, told, OwnLeases(name, evacuates), result,
                      r.random() < 0.5, goal=-start, outline=edge(corners))  # fmt: skip
        machines.append(one)
        for _ in range(r.choice([0, 1, 2])):
            world.after(r.uniform(5, QUIET), one.restart)
        for _ in range(r.choice([0, 0, 1])):
            world.after(r.uniform(5, QUIET), one.give_up)  # its scheduler was restarted, or the run cancelled
    for _ in range(r.choice([0, 1, 2])):
        world.after(r.uniform(5, QUIET), lambda: store.die(r.uniform(0.5, 25.0)))
    for _ in range(r.choice([0, 0, 1])):
        world.after(r.uniform(5, QUIET), lambda: _revoke(store, result, r))
    return machines, areas


def _revoke(store: Store, result: Result, r: random.Random) -> None:
    def act(keeper: Keeper) -> None:
        if keeper.book.claims:
            keeper.revoke(r.choice(sorted(keeper.book.claims)), "a person")
            result.revoked += 1

    store.change(act)
