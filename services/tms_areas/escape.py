"""The way back of a machine that stands where it must not: slow motions that only bring it further in, and no others.

A person allows it, and it takes the place of the guard until the machine is inside with its margin. How far the machine
is out is measured for each area by itself: none may be entered on the way out of another one.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import shapely

from tms_areas.body import Body, Silhouette
from tms_areas.fix import Motion, Seen
from tms_areas.guard import Verdict
from tms_areas.law import Law
from tms_areas.reach import Place, between, shape_of
from tms_areas.reasons import ComesFurtherOut, EscapesTooFast, NotFurtherIn, TracksNotSlow
from tms_reason.reason import Reason

SPEED = 0.2  # m/s of tracks on the way back, at most; turns are slowed by the same share of the machine's top
FASTER = 1.5  # times that what is measured may be: poses vary
GROWS = 0.15  # m that a machine may seem further out: what poses vary, and corners swing
TOUCHES = 0.03  # m, where it was not in an area at all
LESS = 0.05  # m that a goal must bring it further in


@dataclass(frozen=True)
class Trespass:
    """How far a machine is out [m]: `depth` is that of its farthest point from where it may be.

    `strips` are what it covers of each closed area, and at last beside the unmanned ones, by its own length.
    """

    depth: float
    strips: tuple[float, ...]

    def further_out(self, before: "Trespass") -> bool:
        """Whether it has grown anywhere by more than poses vary."""
        pairs = zip(self.strips, before.strips, strict=True)
        grown = any(now > then + (GROWS if then > 0 else TOUCHES) for now, then in pairs)
        return grown or self.depth > before.depth + GROWS

    def less(self, before: "Trespass") -> bool:
        """Whether a machine is further in than before."""
        return before.depth - self.depth > LESS or sum(before.strips) - sum(self.strips) > LESS

    def least(self, other: "Trespass") -> "Trespass":
        """The least of both, for each area."""
        return Trespass(min(self.depth, other.depth), tuple(map(min, self.strips, other.strips)))


class Escape:
    """The guard on the way back. One thread looks, which also remembers how far in the machine has come."""

    def __init__(self, law: Law, silhouette: Silhouette) -> None:
        self._law, self._silhouette = law, silhouette
        self._best: Trespass | None = None

    def over(self, seen: Seen, joints: Mapping[str, float]) -> bool:
        """Whether the machine is inside with its margin, and tracks and joints may move by the law again."""
        if seen.unsure is not None or seen.motion is None:
            return False
        body, still = self._silhouette.body([joints]), _still(seen.motion)
        return self._law.working(body, still) is None and self._law.driving(body, still) is None

    def look(self, seen: Seen, joints: Mapping[str, float], tracks: bool) -> Verdict:
        """Whether a motion may go on; `joints` [rad] now, `tracks`: it drives."""
        if seen.unsure is not None or seen.motion is None:
            return Verdict(hold=seen.unsure)
        body, motion = self._silhouette.body([joints]), seen.motion
        now = self._trespass(body, motion)
        best = self._best or now
        comes = self._trespass(body, self._law.stopped(motion)) if tracks else now
        if now.further_out(best) or comes.further_out(best):
            return Verdict(stop=ComesFurtherOut(self._law.machine, max(now.depth, comes.depth), best.depth))
        self._best = now.least(best)
        return Verdict(stop=self._too_fast(motion) if tracks else None)

    def may_drive(self, seen: Seen, joints: Mapping[str, float], way: Sequence[Place], told: bool) -> Reason | None:
        """Why tracks must not go to the last of some places; `told`: straight from each to the next.

        Of a way that a planner chooses, only the places are known here; the looks find where it leads further out.
        """
        if seen.unsure is not None or seen.motion is None:
            return seen.unsure
        if not self._law.slow:
            return TracksNotSlow(self._law.machine)
        body, here = self._silhouette.body([joints]), seen.motion
        places = [(here.x, here.y, here.yaw), *way]
        if told:
            places = [place for old, new in pairwise(places) for _, place in between(old, new)]
        return self._lessens([self._trespass(body, Motion(*place)) for place in places])

    def may_work(self, seen: Seen, way: Sequence[Mapping[str, float]]) -> Reason | None:
        """Why joints must not go a way of straight lines between angles [rad], the first of which are those of now."""
        if seen.unsure is not None or seen.motion is None:
            return seen.unsure
        still = _still(seen.motion)
        return self._lessens([self._trespass(body, still) for body in self._silhouette.stages(way)])

    def _lessens(self, way: Sequence[Trespass]) -> Reason | None:
        best = way[0]
        for one in way:
            if one.further_out(best):
                return ComesFurtherOut(self._law.machine, one.depth, best.depth)
            best = one.least(best)
        return None if way[-1].less(way[0]) else NotFurtherIn(self._law.machine, way[0].depth, way[-1].depth)

    def _too_fast(self, motion: Motion) -> Reason | None:
        tracks = self._law.tracks
        if tracks is None:
            return None
        share = SPEED / tracks.forward.top
        times = max(math.hypot(motion.vx, motion.vy) / SPEED, abs(motion.turning) / (tracks.turning.top * share))
        return EscapesTooFast(self._law.machine, times * SPEED, SPEED) if times > FASTER else None

    def _trespass(self, body: Body, motion: Motion) -> Trespass:
        shape, length = shape_of(body, motion), 2 * max(float(np.hypot(*one.corners.T).max()) for one in body.parts)
        out = self._law.trespasses(shape)
        depth = self._law.away(shapely.get_coordinates(out))
        return Trespass(depth, tuple(float(one.area) / length for one in out))


def _still(motion: Motion) -> Motion:
    return replace(motion, vx=0.0, vy=0.0, turning=0.0)
