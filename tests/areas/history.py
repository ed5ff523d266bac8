"""One seeded history of a machine between areas, watched by the gateway's law, against where it truly is."""

import itertools
import math
import random
from dataclasses import dataclass, field

import numpy as np
from shapely import Point as Point2

from areas.plant import STEP, TROUBLES, Ground, Localisation, Plant, Trouble
from areas.truth import Array, Rules, edge
from tms_areas.areas import Area, AreaSet, Point, ring
from tms_areas.body import Body, Part, Silhouette
from tms_areas.braking import Axis, Tracks
from tms_areas.fix import SURE, Fix
from tms_areas.guard import Guard, Verdict
from tms_areas.law import Law
from tms_areas.reach import Place

SECONDS = 60.0  # of a history
# A machine that goes faster than m/s for some seconds without a right pose must not be driven any more. While it stands
# nobody sees that its localisation hangs.
BLIND, MOVES = 1.2, 0.1
BEAT = 0.05  # s between looks of the gateway
LINK = 0.08  # s at most from a decision to the command at the machine
GENTLE = 0.8  # share of the acceleration with which a driver brakes for its goal
ALIGNED, STANDS = 0.05, 0.02  # rad, rad/s: where its turn on the spot ends, as in tms_control.pursuit
AHEAD, CREEP = 2.0, 0.05  # m ahead on its line that it steers for, m/s with which it arrives
WRONG = 0.45  # m that no pose is off but one after a jump: drift, noise, and what it travels until it is heard
DASHES = 5  # kinds of dashes, by turns
SLOWEST = 0.15  # s of the slowest poses
NEAR = 0.3  # m, rad: there


class Outline(Silhouette):
    """A machine whose joints stand still."""

    def __init__(self, corners: Array) -> None:
        self.most = float(np.hypot(*corners.T).max())
        self._whole = Body((Part(corners, self.most),))

    def body(self, joints: object) -> Body:
        return self._whole


@dataclass
class Driver:
    """Drives to goals one after the other, or wherever it likes.

    To a goal it turns on the spot, stands, and drives along a straight line, as our controllers do; it knows how late
    the tracks answer, as they do.
    """

    random: random.Random
    wild: bool
    top: float
    acceleration: float
    turn_top: float
    goals: list[Point]
    until: float = 0.0
    wish: tuple[float, float] = (0.0, 0.0)
    begun: Place | None = None  # where the line to the present goal begins, and its heading
    turned: bool = False

    def speeds(self, now: float, plant: Plant) -> tuple[float, float]:
        """What it commands: speed and turning."""
        if self.wild:
            if now >= self.until:
                self.until = now + self.random.uniform(1.0, 8.0)
                self.wish = (self.random.choice([-1, 1, 1]) * self.random.uniform(0, self.top),
                             self.random.choice([0.0, self.random.uniform(-1, 1) * self.turn_top]))  # fmt: skip
            return self.wish
        if not self.goals:
            return 0.0, 0.0
        if self.begun is None:
            here = plant.x, plant.y, plant.yaw
            self.begun = (*here[:2], _facing(here, (*self.goals[0], 0.0))[2])
        late = plant.dead_time + plant.lag
        yaw = plant.yaw + plant.w * late
        if not self.turned:
            return 0.0, self._turn(self.begun[2], yaw, plant)
        return self._along(self.begun, yaw, plant, late)

    def _turn(self, heading: float, yaw: float, plant: Plant) -> float:
        off = math.remainder(heading - yaw, math.tau)
        aligned = abs(off) < ALIGNED
        self.turned = aligned and abs(plant.w) < STANDS
        return 0.0 if aligned else max(-self.turn_top, min(self.turn_top, off))

    def _along(self, line: Place, yaw: float, plant: Plant, late: float) -> tuple[float, float]:
        """Pure pursuit of a line to the present goal."""
        x, y, heading = line
        c, s = math.cos(heading), math.sin(heading)
        dx, dy = plant.x - x, plant.y - y
        beside = -s * dx + c * dy
        left = math.dist((x, y), self.goals[0]) - (c * dx + s * dy) - plant.v * late
        if left <= NEAR:
            self.goals.pop(0)
            self.begun, self.turned = None, False
            return 0.0, 0.0
        v = min(self.top, math.sqrt(2 * GENTLE * self.acceleration * (left - NEAR)) + CREEP)
        off = math.remainder(heading + math.atan2(-beside, AHEAD) - yaw, math.tau)
        return v, max(-self.turn_top, min(self.turn_top, 2 * v * math.sin(off) / math.hypot(beside, AHEAD)))


@dataclass
class Result:
    """What a history has shown."""

    seed: int
    wild: bool
    crossed: float | None = None  # when the machine truly was where it must not be
    blind: float | None = None  # when it drove although nobody could know where it was
    misled: float | None = None  # when it was stopped for good by a pose that was wrong by more than poses may be
    stopped: float | None = None  # when the law stopped it
    why: str = ""
    held: int = 0
    would_cross: bool = False  # without the law
    refused: bool = False
    reached: int = 0  # goals

    @property
    def violation(self) -> str:
        """What must never happen and did, in words."""
        if self.crossed is not None:
            return f"the machine is where it must not be, at {self.crossed:.2f} s"
        if self.blind is not None:
            return f"nobody knows where it drives, at {self.blind:.2f} s"
        return "" if self.misled is None else f"a wrong pose is believed, at {self.misled:.2f} s"


@dataclass
class Made:
    """Everything that a seed decides."""

    areas: AreaSet
    rules: Rules
    corners: Array
    tracks: Tracks
    slip: float
    lag: float
    start: Place
    troubles: list[Trouble]
    wild: bool
    goals: list[Point] = field(default_factory=list)


def made(seed: int, dash: bool = False) -> Made:
    """A site, a machine in it, and what goes wrong. `dash`: tracks as slow as their model says, and no goals."""
    r = random.Random(seed)
    corners = _machine(r)
    areas, polygons, closed = _areas(r)
    lag, acceleration = r.uniform(0.3, 1.4), r.uniform(0.3, 0.8)
    tracks = Tracks(Axis(r.uniform(0.5, 1.2), acceleration, lag), Axis(r.uniform(0.2, 0.5), r.uniform(0.2, 0.5), lag),
                    r.choice([0.0, r.uniform(0.0, 0.9)]))  # fmt: skip
    troubles = []
    for _ in range(r.choice([0, 0, 1, 2, 3])):
        begins, away, to = r.uniform(6, SECONDS), r.uniform(0.6, 3.0), r.uniform(0, math.tau)
        lasts = r.uniform(0.2, 4.5)
        troubles.append(Trouble(r.choice(TROUBLES), begins, begins + lasts, away * math.cos(to), away * math.sin(to),
                                r.choice([0.0, r.uniform(-0.5, 0.5)])))  # fmt: skip
    out = Made(areas, Rules(polygons, closed), corners, tracks, r.choice([0.0, 0.1, 0.4]), lag * r.uniform(0.6, 1.0),
               (0.0, 0.0, 0.0), troubles, r.random() < 0.5)  # fmt: skip
    law = Law(areas, "machine", tracks)
    body = Outline(corners).body(())
    places = [one for _ in range(300) if law.arriving(body, one := _anywhere(r)) is None]
    if dash:
        out.lag, out.slip, out.wild = lag, 0.0, True
        out.start = _for_a_dash(seed, places, law)
    elif places:
        out.start = places[0]
        straight = (one for one in places[1:] if law.path(body, [places[0], *_turn_and_go(places[0], one)]) is None)
        out.goals = [one[:2] for one in itertools.islice(straight, 1)]
    return out


def _for_a_dash(seed: int, places: list[Place], law: Law) -> Place:
    """Where a dash begins: those that turn on the spot, at the place that is nearest to a border."""
    if not places:
        return 0.0, 0.0, 0.0
    border = law.areas.usable().boundary
    return places[0] if seed % DASHES else min(places, key=lambda one: border.distance(Point2(*one[:2])))


def _dash(seed: int, tracks: Tracks) -> tuple[float, float]:
    """The command of a dash: by turns on the spot, backwards, and three times ahead."""
    kind = seed % DASHES
    if kind == 0:
        return 0.0, tracks.turning.top
    return (-tracks.forward.top if kind == 1 else tracks.forward.top), 0.0


def _way(plant: Plant, goal: Point) -> list[Place]:
    """How a driver goes to a goal: it turns, then drives straight."""
    return _turn_and_go((plant.x, plant.y, plant.yaw), (*goal, 0.0))


def _turn_and_go(old: Place, new: Place) -> list[Place]:
    there = _facing(old, new)
    return [(*old[:2], there[2]), there]


def _facing(old: Place, new: Place) -> Place:
    return new[0], new[1], math.atan2(new[1] - old[1], new[0] - old[0])


def _anywhere(r: random.Random) -> Place:
    return r.uniform(-30, 30), r.uniform(-30, 30), r.uniform(-math.pi, math.pi)


def _machine(r: random.Random) -> Array:
    front, back, half = r.uniform(1.0, 3.5), r.uniform(1.0, 3.5), r.uniform(0.8, 1.8)
    return np.array([(-back, -half), (front, -half), (front, half), (-back, half)])


def _areas(r: random.Random) -> tuple[AreaSet, list[Array], list[Array]]:
    """One or two unmanned areas, bent inwards and out, and some that are closed inside of them."""
    found = []
    for number in range(r.choice([1, 1, 2])):
        count, x, y = r.randint(5, 14), r.uniform(-8, 8) * number, r.uniform(-8, 8) * number
        turns = [math.tau * i / count for i in range(count)]
        far = [r.uniform(14, 28) for _ in turns]
        found.append(
            Area(
                f"u{number}",
                "unmanned",
                ring([(x + d * math.cos(t), y + d * math.sin(t)) for d, t in zip(far, turns, strict=True)]),
            )
        )
    for number in range(r.choice([0, 1, 2, 3])):
        x, y, size = r.uniform(-20, 20), r.uniform(-20, 20), r.uniform(1.0, 4.0)
        kind = r.choice(["blocked", "manned", "restricted", "release"])
        found.append(
            Area(
                f"c{number}",
                kind,
                ring([(x, y), (x + size, y), (x + size, y + size), (x, y + size * r.uniform(0.3, 1))]),
            )
        )  # type: ignore[arg-type]
    shapes = [np.array(one.corners) for one in found]
    open_ones = [shape for one, shape in zip(found, shapes, strict=True) if one.kind == "unmanned"]
    return AreaSet(tuple(found)), open_ones, shapes[len(open_ones) :]


def run(seed: int, guarded: bool = True, keeps_on: float = math.inf, dash: bool = False) -> Result:
    """The history of a seed; not `guarded`: without the law, until it crosses. From `keeps_on` [s] on a wild driver's
    command stays what it is. `dash`: it goes as fast as it can in one direction, as often as it is let, and all is as
    late, and as far off, as it may be."""
    what, r = made(seed, dash), random.Random(seed + 1)
    out = Result(seed, what.wild)
    fix, law = Fix(what.tracks.turning.top), Law(what.areas, "machine", what.tracks)
    guard, outline = Guard(law, Outline(what.corners)), edge(what.corners)
    plant = Plant(Ground(random.Random(seed + 2)), what.slip, what.tracks.dead_time, what.lag, *what.start)
    told = Localisation(random.Random(seed + 3), r.choice([0.06, 0.1]), r.choice([0.02, 0.15]),
                        r.choice([0.002, 0.01, 0.02]), r.uniform(0, 0.1), what.troubles if guarded else [],
                        r.uniform(0, 6))  # fmt: skip
    driver = Driver(random.Random(seed + 4), what.wild, what.tracks.forward.top, what.tracks.forward.acceleration,
                    what.tracks.turning.top, list(what.goals))  # fmt: skip
    if dash:
        driver.until, driver.wish = math.inf, _dash(seed, what.tracks)
        told.delay, told.noise, told.drift = SLOWEST, 0.002, SURE
    going, stopped, next_beat, wrong = False, False, 0.0, False
    stood_at, heard = 0.0, (math.nan, math.nan, math.nan)
    wished = (0.0, 0.0)
    for step in range(round(SECONDS / STEP)):
        plant.step()
        now = plant.now
        for at, pose in told.take(now, (plant.x, plant.y, plant.yaw)):
            fix.heard(at, *pose)
            if pose != heard:  # one that stands to the last bit is no news, and gets old instead
                wrong, heard = math.dist(pose[:2], (plant.x, plant.y)) > WRONG, pose
        fix.odometry(plant.v, plant.w)
        if now >= next_beat:
            next_beat = now + BEAT * r.uniform(0.8, 1.4)
            seen = fix.look(now)
            verdict = guard.look(seen, {}, tracks=True) if guarded else Verdict()
            if verdict.stop is not None and going:
                out.stopped, out.why = now, verdict.stop.code
                out.misled = now if wrong else None
                stopped, going = True, False
                plant.command(0.0, 0.0, LINK if dash else r.uniform(0, LINK))
            elif verdict.hold is not None and going:
                out.held, going = out.held + 1, False
                plant.command(0.0, 0.0, r.uniform(0, LINK))
            elif verdict.hold is None and verdict.stop is None and not going and not stopped:
                going = True
                if guarded and driver.goals and guard.may_drive(seen, {}, _way(plant, driver.goals[0]), told=True):
                    out.refused = True
                    break
            if going:
                goals = len(driver.goals)
                driver.until = math.inf if now >= keeps_on else driver.until
                wished = _limited(driver.speeds(now, plant), wished, what, next_beat - now)
                out.reached += goals - len(driver.goals)
                plant.command(*wished, r.uniform(0, 0.02))
            else:
                wished = (0.0, 0.0)
        stood_at = stood_at if abs(plant.v) > MOVES else now
        if guarded and going and now - max(told.right_at, stood_at) > BLIND:
            out.blind = now
            break
        if step % 10 == 0 and what.rules.broken(outline, plant.x, plant.y, plant.yaw):
            out.crossed = now
            break
        if stopped and abs(plant.v) < 0.005 and not plant.coming:
            break
    return out


def _limited(wish: tuple[float, float], now: tuple[float, float], what: Made, passed: float) -> tuple[float, float]:
    """Commands do not change faster than the tracks may."""
    most = what.tracks.forward.acceleration * passed, what.tracks.turning.acceleration * passed
    v, w = (one + max(-d, min(d, to - one)) for to, one, d in zip(wish, now, most, strict=True))
    return v, w
