"""What areas mean for one machine: whether it may go on, may begin a goal, and how fast it may be.

It may go on while it could still be stopped inside: everything that it can reach until a stop that is commanded at
the next look has worked must be where it may be. That is what its motion does in the time that nobody sees or commands
it (age of the pose, delay, dead time), gaining speed as fast as it can, and its way of braking after that; ahead and
to both sides as far as tracks can change their course meanwhile; and around all of it what the pose may be off.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from tms_areas.areas import FORBIDDEN, AreaSet
from tms_areas.body import Body
from tms_areas.braking import Tracks
from tms_areas.fix import SURE, Motion
from tms_areas.reach import (
    Array,
    Covered,
    Place,
    Reach,
    between,
    bulge,
    covered_by,
    ends,
    nearest,
    parts_of,
    place_of,
    places_of,
)
from tms_areas.reasons import EntersArea, LeavesArea, NoWay, TooFastFor
from tms_reason.reason import Reason

DELAY = 0.15  # s from where a machine is to the message that says so
BEAT = 0.15  # s from one look at the newest pose to the next one, and until its command has left
FASTER = 1.15  # times a speed limit that a measured speed may be
HEED, GENTLE = 1.5, 0.4  # s until tracks obey a speed limit, and share of their acceleration with which they slow down
HEEDED = 0.9  # times a limit that they are told: what is measured varies
SPARE = 0.15  # m more for what is planned: poses vary while it drives
PLANNED = 0.1  # s, age of a pose that plans reckon with
SPOT = 0.05  # m; a turn over a shorter way is one on the spot
STRAY = 0.05  # m that tracks may slip to any side while they brake


class Law:
    """The areas that are enabled, for one machine."""

    def __init__(
        self,
        areas: AreaSet,
        machine: str,
        tracks: Tracks | None,
        held: frozenset[str] = frozenset(),
        slow: bool = False,
    ) -> None:
        """`held`: the release areas whose holder the machine is; `slow`: what drives its tracks takes speed limits."""
        self.areas, self.machine, self.tracks = areas, machine, tracks
        self.held, self.slow = held, slow
        self._usable = areas.usable(held)
        self._border = self._usable.boundary
        self._pieces = shapely.get_parts(self._usable)
        self._closed = [one for one in areas.of(*FORBIDDEN, "release") if one.id not in held]
        self._unmanned = shapely.union_all([one.polygon for one in areas.of("unmanned")])
        self._limits = areas.of("speed_limit")
        self._limited = np.array([one.polygon for one in self._limits], dtype=object)
        self._closed_tree = shapely.STRtree([one.polygon for one in self._closed])
        ends = [pair for line in shapely.get_parts(self._border) for pair in itertools.pairwise(line.coords)]
        self._sides = shapely.linestrings(ends)  # of the border: a tree of them finds the nearest one at once
        self._tree = shapely.STRtree(self._sides)
        for shape in (self._usable, self._border, *(one.polygon for one in (*self._closed, *self._limits))):
            shapely.prepare(shape)

    # while it moves

    def clear(self, motion: Motion, most: float, more: float, tracks: bool) -> bool:
        """Whether it may go on whatever its joints, as no border is near: the usual case, for a tenth of a full look.

        `most`: how far its farthest point is from its base in any pose [m]; `more`: as in `working`; `tracks`: it
        drives. The circle holds all that `working` or `driving` would look at.
        """
        reach = self._reach(motion) if tracks else Reach(0.0, 0.0, 0.0, 0.0, 0.0, motion.off + more)
        way = math.hypot(max(abs(reach.back), abs(reach.ahead)), reach.side)
        radius = way + most * (1.0 + bulge((reach.left - reach.right) / 4)) + reach.around
        here = shapely.Point(motion.x, motion.y)
        if not self._usable.contains(here) or shapely.dwithin(self._border, here, radius):
            return False
        return not (tracks and shapely.dwithin(self._limited, here, radius).any())

    def driving(self, body: Body, motion: Motion) -> Reason | None:
        """Why tracks must stop now; None if they may go on until the next look."""
        reach = self._reach(motion)
        covered = self._passed(body, motion, reach)
        wrong = self._outside(covered, body, motion, reach.most)
        return wrong if wrong is not None else self._too_fast(covered, math.hypot(motion.vx, motion.vy))

    def until_it_stands(self, body: Body, motion: Motion) -> Covered:
        """All that a machine on tracks may cover until a stop that is commanded at the next look has worked."""
        return self._passed(body, motion, self._reach(motion))

    @staticmethod
    def _passed(body: Body, motion: Motion, reach: Reach, more: float = 0.0) -> Covered:
        return covered_by(body, places_of(motion, reach), (reach.left - reach.right) / 4, reach.around + more)

    @staticmethod
    def now(body: Body, motion: Motion) -> Covered:
        """What a machine covers where it is, with what its pose may be off."""
        return covered_by(body, place_of(motion), 0.0, motion.off)

    @property
    def paces(self) -> bool:
        """Whether anything may limit the speed of the tracks."""
        return self.tracks is not None and bool(self._limits)

    def pace(self, body: Body, motion: Motion) -> float:
        """How fast tracks may go [m/s]: as a speed limit says that is nearer than they need to slow down."""
        if not self.paces:
            return math.inf
        near = shapely.dwithin(self._limited, parts_of(body, motion), self._slowing)
        return min((HEEDED * (one.speed or 0.0) for one, slow in zip(self._limits, near, strict=True) if slow),
                   default=math.inf)  # fmt: skip

    def working(self, body: Body, motion: Motion, more: float = 0.0) -> Reason | None:
        """Why a machine must not move its joints, standing; `more`: m around it in addition to what its pose is off."""
        around = motion.off + more
        return self._outside(covered_by(body, place_of(motion), 0.0, around), body, motion, around)

    # before a goal

    def arriving(self, body: Body, place: Place, off: float = SURE) -> Reason | None:
        """Why a machine on tracks must not go to a place: it would be stopped when it arrives there.

        `off`: m that its pose may be off, as it is now.
        """
        at = Motion(*place, off=off, age=PLANNED)
        return self._planned(body, at, replace(self._reach(at), back=-self._arrival, ahead=self._arrival))

    def path(self, body: Body, places: Sequence[Place], off: float = SURE) -> Reason | None:
        """Why a machine must not drive along places, straight from each to the next: where it would be stopped.

        It is taken to drive as fast as it can, and to brake for the end, and for turns on the spot; `off`: m that its
        pose may be off, as it is now.
        """
        left = sum(math.dist(old[:2], new[:2]) for old, new in itertools.pairwise(places))
        for old, new in itertools.pairwise(places):
            way, turn = math.dist(old[:2], new[:2]), math.remainder(new[2] - old[2], math.tau)
            backward = math.cos(old[2]) * (new[0] - old[0]) + math.sin(old[2]) * (new[1] - old[1]) < 0
            for share, (x, y, yaw) in between(old, new):
                speed, turning = self._paced(left - share * way, way, turn, 1.0 - share)
                speed = -speed if backward else speed
                motion = Motion(x, y, yaw, speed * math.cos(yaw), speed * math.sin(yaw), turning, off, PLANNED)
                if (wrong := self._planned(body, motion, self._reach(motion))) is not None:
                    return wrong
            left -= way
        return None

    def _paced(self, left: float, way: float, turn: float, rest: float) -> tuple[float, float]:
        """Speed and turning on a piece of a path: `left` m before its end, `rest` of the piece still to go."""
        if self.tracks is None:
            return 0.0, 0.0
        forward, turning = self.tracks.forward, self.tracks.turning
        if way < SPOT:
            pace = math.sqrt(2 * turning.acceleration * abs(turn) * rest)
            return 0.0, math.copysign(min(turning.top, pace), turn)
        speed = min(
            forward.top, math.sqrt(2 * forward.acceleration * max(left, 0.0)), turning.top * way / max(abs(turn), 1e-9)
        )
        return speed, turn / way * speed

    def _planned(self, body: Body, motion: Motion, reach: Reach) -> Reason | None:
        covered = self._passed(body, motion, reach, SPARE)
        return self._outside(covered, body, motion, reach.most) or self._slow(covered)

    def apart(self, here: Place, there: Place) -> Reason | None:
        """Why no way at all leads from one place to another: both must be in one piece of where it may be."""
        inside = [shapely.contains_xy(self._pieces, *one[:2]) for one in (here, there)]
        return None if (inside[0] & inside[1]).any() else NoWay(self.machine, *there[:2])

    # out of where it may be

    def trespasses(self, shape: BaseGeometry) -> list[BaseGeometry]:
        """What of a shape is in each closed area, and at last what is beside the unmanned ones."""
        return [*(shape.intersection(one.polygon) for one in self._closed), shape.difference(self._unmanned)]

    def away(self, corners: Array) -> float:
        """How far the farthest of some places (N x 2) is from where the machine may be [m]; 0 for none."""
        return float(shapely.distance(shapely.points(corners), self._usable).max(initial=0.0))

    def stopped(self, motion: Motion) -> Motion:
        """Where a machine will stand that is stopped at the next look, if it goes on as it does."""
        reach = self._reach(motion)
        turn, ahead = (reach.right + reach.left) / 2, (reach.back + reach.ahead) / 2
        course = motion.yaw + turn / 2
        return Motion(motion.x + math.cos(course) * ahead, motion.y + math.sin(course) * ahead, motion.yaw + turn)

    # how far

    @cached_property
    def _arrival(self) -> float:
        """How far from a border a machine must be able to arrive [m]: on the way there it brakes as it is planned."""
        if self.tracks is None:
            return 0.0
        forward = self.tracks.forward
        speeds = np.linspace(0.0, forward.top, 20).tolist()
        ahead = [
            self._reach(Motion(0, 0, 0, one, age=PLANNED)).ahead - one**2 / (2 * forward.acceleration) for one in speeds
        ]
        return float(max(ahead))

    @cached_property
    def _slowing(self) -> Array:
        """How far before each speed limit tracks at top speed must be told it [m].

        They must have obeyed before the limit is in what they could reach until they stand.
        """
        if self.tracks is None:
            return np.zeros(len(self._limits))
        forward = self.tracks.forward
        stop = self._reach(Motion(0.0, 0.0, 0.0, forward.top, age=PLANNED)).most
        limits = np.array([one.speed or 0.0 for one in self._limits])
        slower = np.maximum(forward.top**2 - limits**2, 0.0) / (2 * GENTLE * forward.acceleration)
        way: Array = stop + HEED * forward.top + slower
        return way

    @property
    def blind(self) -> float:
        """How long the tracks go on unseen and uncommanded after the newest pose came [s]."""
        return DELAY + BEAT + (0.0 if self.tracks is None else self.tracks.dead_time)

    def _reach(self, motion: Motion) -> Reach:
        if self.tracks is None:
            return Reach(0.0, 0.0, 0.0, 0.0, 0.0, motion.off)
        c, s = math.cos(motion.yaw), math.sin(motion.yaw)
        forward, aside = c * motion.vx + s * motion.vy, c * motion.vy - s * motion.vx
        blind = motion.age + self.blind
        factor = self.tracks.factor
        back, ahead = ends(self.tracks.forward, forward, blind, factor)
        right, left = ends(self.tracks.turning, motion.turning, blind, factor)
        side = aside * blind + math.copysign(self.tracks.forward.braking(aside), aside) * factor
        return Reach(back, ahead, side, right, left, motion.off + STRAY)

    # where

    def _outside(self, covered: Covered, body: Body, motion: Motion, needed: float) -> Reason | None:
        out = ~shapely.contains(self._usable, covered.shapes)
        out |= shapely.dwithin(self._border, covered.shapes, covered.around)
        return self._why(*covered.parts[int(out.argmax())], body, motion, needed) if out.any() else None

    def _why(self, shape: BaseGeometry, around: float, body: Body, motion: Motion, needed: float) -> Reason:
        """Which area is the next one that it must not enter, or leave; where, how far, and how far it needs."""
        now = parts_of(body, motion)
        entered = self._closed_tree.query(shape, predicate="dwithin", distance=around)
        if len(entered):
            gaps = shapely.distance(self._closed_tree.geometries[entered], now)
            area = self._closed[int(entered[gaps.argmin()])]
            gap, x, y = nearest(area.polygon, now)
            return EntersArea(self.machine, area.id, gap, needed, x, y)
        gap, x, y = nearest(self._sides[self._tree.query_nearest(now, all_matches=False)[0]], now)
        at = shapely.Point(x, y)
        left = min(self.areas.of("unmanned"), key=lambda area: float(shapely.distance(area.polygon, at)))
        inside = shapely.contains(self._usable, now.geoms).all()
        return LeavesArea(self.machine, left.id, gap if inside else 0.0, needed, x, y)

    def _too_fast(self, covered: Covered, speed: float) -> Reason | None:
        """The speed limit that a machine breaks where it is, or may soon be."""
        for area in self._limits:
            limit = area.speed or 0.0
            if speed > limit * FASTER and shapely.intersects(area.polygon, covered.shapes).any():
                return TooFastFor(self.machine, area.id, speed, limit)
        return None

    def _slow(self, covered: Covered) -> Reason | None:
        """A goal tells no speed: what takes no limit may drive at the machine's top speed anywhere."""
        if self.tracks is None or self.slow:
            return None
        return self._too_fast(covered, self.tracks.forward.top)
