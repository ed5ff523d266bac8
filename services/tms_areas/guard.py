"""The watch over one machine by its areas: at each look, whether its motion may go on.

While its place is not believed, tracks are stopped and held; until then each look has shown that they can still be
stopped inside. An arm may finish where it would be inside even if the last believed place were off some more.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tms_areas.body import Body, Silhouette
from tms_areas.fix import Seen
from tms_areas.law import Law
from tms_areas.reach import Place
from tms_reason.reason import Reason

UNSURE = 0.5  # m around an arm that works although the place of its machine is not believed


@dataclass(frozen=True)
class Verdict:
    """What follows from one look."""

    stop: Reason | None = None  # and latch
    hold: Reason | None = None  # its goal ends, and the next one waits until this is over


class Guard:
    """The law for one machine, and its shape. It keeps nothing: threads may share it."""

    def __init__(self, law: Law, silhouette: Silhouette) -> None:
        self.law, self._silhouette = law, silhouette

    def body(self, joints: Mapping[str, float]) -> Body:
        """What holds the machine at some joints [rad]."""
        return self._silhouette.body([joints])

    def look(self, seen: Seen, joints: Mapping[str, float], tracks: bool) -> Verdict:
        """Whether a goal may go on; `joints` [rad] now, `tracks`: it drives."""
        unsure, motion = seen.unsure, seen.motion
        if motion is None or (tracks and unsure is not None):
            return Verdict(hold=unsure)
        more = 0.0 if unsure is None else UNSURE
        if self.law.clear(motion, self._silhouette.most, more, tracks):
            return Verdict()
        body = self.body(joints)
        if tracks:
            return Verdict(stop=self.law.driving(body, motion))
        wrong = self.law.working(body, motion, more)
        return Verdict(stop=wrong) if unsure is None or wrong is None else Verdict(hold=unsure)

    def pace(self, seen: Seen, joints: Mapping[str, float]) -> float:
        """How fast the tracks may go now [m/s]; infinite where nothing limits them."""
        if seen.motion is None or not self.law.paces:  # asked at each look: no geometry for nothing
            return math.inf
        return self.law.pace(self.body(joints), seen.motion)

    def may_drive(self, seen: Seen, joints: Mapping[str, float], way: Sequence[Place], told: bool) -> Reason | None:
        """Why tracks must not go to the last of some places by way of the others.

        `told`: straight from each to the next. Else a planner chooses the way, of which only this is known here: it
        stays in one piece of where the machine may be.
        """
        verdict, motion = self.look(seen, joints, tracks=True), seen.motion
        wrong = verdict.hold or verdict.stop
        if wrong is not None or motion is None:
            return wrong
        here = (motion.x, motion.y, motion.yaw)
        body = self.body(joints)
        if told:
            return self.law.path(body, (here, *way), motion.off) or self.law.arriving(body, way[-1], motion.off)
        found = (self.law.arriving(body, place, motion.off) or self.law.apart(here, place) for place in way)
        return next((one for one in found if one is not None), None)

    def may_work(self, seen: Seen, way: Sequence[Mapping[str, float]]) -> Reason | None:
        """Why joints must not go a way of straight lines between angles [rad], the first of which are those of now."""
        unsure, motion = seen.unsure, seen.motion
        if motion is None:
            return unsure
        wrong = self.law.working(self._silhouette.swept(way), motion, 0.0 if unsure is None else UNSURE)
        return unsure if wrong is not None and unsure is not None else wrong
