"""A way to each target of a goal: the straight one if it is free, else around what is in the way."""

import contextlib
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tms_config.models import MachineModel
from tms_control.links import Array
from tms_control.reasons import PathBlocked
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.broken_off import rest
from tms_rp.clearance import Clearance
from tms_rp.flow import Flow
from tms_rp.kind import Angles, MachineKind, Moves, Way
from tms_rp.plan import Plan
from tms_rp.plans import START, one_trajectory, scaled, without_stops
from tms_rp.reasons import Around, Collision, NoWayRound, PlanElsewhere, Searched, SlowlyOut
from tms_rp.sampling import search
from tms_rp.scene import Scene
from tms_rp.trajectory import Joints, Trajectory, trajectory
from tms_rp.view import Nearest, View
from tms_rp.way_out import way_out

SLOW = 0.25  # share of the limits with which an arm comes out of something


class Ways:
    """Plans for one machine."""

    def __init__(self, model: MachineModel, kind: MachineKind) -> None:
        self._model, self._kind = model, kind
        self._clearance = Clearance(model)
        # While it moves, only what is really in the way: places that are told are some centimetres apart each time.
        self._touching = Clearance(model, padding=0.0)
        moved = [(model.joints[name], model.response[name]) for name in kind.joints]
        lates = [answer.dead_time + answer.lag for _, answer in moved]
        self.late = max(lates)  # s behind the trajectory
        apart = (max(lates) - min(lates)) / 2  # s that a joint is ahead of, or behind, the others at most
        self._aside = [START + apart * joint.velocity for joint in model.joints.values()]  # rad beside a path
        self._flow = Flow(model, kind, self._clearance, self._all_joints, self._way)
        self._stopping = max(joint.velocity / joint.acceleration for joint, _ in moved)  # s to brake

    def plan(self, now: Angles, moves: Moves, scene: Scene) -> Plan:
        """The trajectory over all targets of `moves`.

        It goes straight from target to target as long as it touches nothing, however low that leads. A way around
        stays above the ground, but for its ends. Stored plans keep their path but for its corners, or are refused.

        Raises:
            SubtaskFailed: Collision: a target itself is not free. NoWayRound. NoTrajectory, LimitsLeft. PlanWrong.
        """
        now = moves.begin or now
        if moves.plans:
            return self._stored(now, moves, scene)
        moves = self._out(now, moves, scene)
        if moves.through is not None:
            return self._flow.plan(now, moves, moves.through, scene)
        straight = self._trajectory(now, moves)
        try:
            self._clearance.check(straight, scene)
        except SubtaskFailed as error:
            return self._around(now, moves, scene, error.reason)
        return Plan(straight, moves.notes, moves, straight.stops)

    def _stored(self, now: Angles, moves: Moves, scene: Scene) -> Plan:
        """Stored plans one behind the other; without stops between them if that is free and quicker."""
        try:
            made = one_trajectory(self._model.joints, self._all_joints(now), moves.plans)
        except SubtaskFailed as error:
            return self._broken_off(now, moves, scene, error)
        flowing = without_stops(self._model.joints, made) if len(moves.plans) > 1 else made
        if flowing.duration < made.duration:
            with contextlib.suppress(SubtaskFailed):
                self._clearance.check(flowing, scene)
                return Plan(flowing, moves.notes, moves)
        self._clearance.check(made, scene)
        return Plan(made, moves.notes, moves)

    def _broken_off(self, now: Angles, moves: Moves, scene: Scene, why: SubtaskFailed) -> Plan:
        """The rest of stored plans that begin elsewhere, where they may have been broken off."""
        if not moves.broken_off or why.reason.find(PlanElsewhere) is None:
            raise why
        found = rest(self._model.joints, self._aside, self._all_joints(now), moves.plans)
        if found is None:
            raise why
        made, goes_on = found
        self._clearance.check(made, scene)
        return Plan(made, (*moves.notes, goes_on), moves)

    def _out(self, now: Angles, moves: Moves, scene: Scene) -> Moves:
        """The same, slow if the arm seems to be in something: then nobody knows how things really stand."""
        with self._touching.looking(scene) as view:
            inside = view.overlap(self._all_joints(now))
        if inside is None:
            return moves
        velocity, acceleration = (min(SLOW, scale) for scale in moves.scales)
        return replace(moves, scales=(velocity, acceleration), notes=(*moves.notes, SlowlyOut(inside)))

    def _parted(self, now: Angles, scene: Scene) -> list[Angles]:
        """Where a way around begins: where the arm is, and, if it seems to be in something, where it is out of that."""
        joints = [self._model.joints[name] for name in self._kind.joints]
        least = [-math.inf if one.min is None else one.min for one in joints]
        most = [math.inf if one.max is None else one.max for one in joints]

        def depths(poses: Array) -> Array:
            return view.depths(np.array([self._all_joints(tuple(pose)) for pose in poses]))

        with self._touching.looking(scene) as view:
            if view.overlap(self._all_joints(now)) is None:
                return [now]
        with self._clearance.looking(scene) as view:
            out = way_out(depths, now, list(zip(least, most, strict=True)))
        return [now] if out is None else [now, out]

    def blocked(self, made: Trajectory, seconds: float, scene: Scene) -> Reason | None:
        """What has come into the way of a trajectory that runs since `seconds`, so near that it must stop now."""
        with self._touching.looking(scene) as view:
            try:
                begin = min(seconds - self.late, made.duration)
                view.check_part(made, begin, seconds + self.late + self._stopping)
            except SubtaskFailed as error:
                why = error.reason
                return PathBlocked(why.second, why) if isinstance(why, Collision) else why
        return None

    def nearest(self, made: Trajectory, scene: Scene) -> Nearest | None:
        """Where a trajectory comes nearest to something, without padding."""
        with self._touching.looking(scene) as view:
            return view.nearest(made)

    def _around(self, now: Angles, moves: Moves, scene: Scene, why: Reason) -> Plan:
        poses, notes, ends = self._parted(now, scene), list(moves.notes), list[int]()
        turned = (0.0,) * len(now)  # rad by which a way has ended elsewhere than the goal asks: whole turns
        for target in moves.targets:
            wanted = tuple(a + b for a, b in zip(target, turned, strict=True))
            way = self._way(poses[-1], wanted, scene, why)
            poses += way.targets
            ends.append(len(poses) - 1)
            turned = tuple(a - b for a, b in zip(way.targets[-1], target, strict=True))
            notes += [Around(way.name, why)] if way.name else []
        made = self._trajectory(now, replace(moves, targets=tuple(poses[1:])), straight=True)
        self._clearance.check(made, scene)
        targets, reached = tuple(poses[end] for end in ends), tuple(made.stops[end - 1] for end in ends)
        return Plan(made, tuple(notes), replace(moves, targets=targets), reached)

    def _way(self, begin: Angles, target: Angles, scene: Scene, why: Reason) -> Way:
        """The first way of one move that is free.

        Raises:
            SubtaskFailed: Collision, NoWayRound.
        """
        straight = Way((target,))
        with self._clearance.looking(scene) as view:
            view.check_end(self._trajectory(begin, Moves(straight.targets)))
            if self._free(view, begin, straight):
                return straight
        with self._clearance.looking(scene.with_ground()) as view:
            for way in self._kind.manners.ways(self._model, begin, target):
                if self._free(view, begin, way):
                    return way
            searched = self._search(view, begin, target)
            if searched is not None and self._free(view, begin, searched):
                return searched
        raise SubtaskFailed(NoWayRound(why))

    def _free(self, view: View, begin: Angles, way: Way) -> bool:
        poses = [self._all_joints(pose) for pose in (begin, *way.targets)]
        if not (all(view.free(pose) for pose in poses[1:-1]) and view.passable(poses)):  # the first costs little
            return False
        try:  # what grazes the padding may be seen at the samples of the motion only
            view.check(self._trajectory(begin, Moves(way.targets), straight=True))
        except SubtaskFailed:
            return False
        return True

    def _search(self, view: View, begin: Angles, target: Angles) -> Way | None:
        """A way that sampling finds, between the ends or poses above them."""
        manners = self._kind.manners

        def free(poses: Sequence[Angles]) -> bool:
            return view.free(*map(self._all_joints, poses))

        def lifted(pose: Angles) -> Angles | None:
            return next((one for one in manners.lifts(self._model, pose) if free([one])), None)

        above = lifted(begin)
        ends = {high: end for end in manners.targets(self._model, begin, target) if (high := lifted(end))}
        if above is None or not ends:
            return None
        bounds = manners.bounds(self._model, [above, *ends])
        found = search(above, list(ends), bounds, free, view.scene.fingerprint())
        return Way((above, *found, ends[found[-1]]), Searched()) if found else None

    def _all_joints(self, pose: Angles) -> Joints:
        """Joints that no kind of goal moves (the tool frame) stay at 0."""
        angles = dict(zip(self._kind.joints, pose, strict=True))
        return tuple(angles.get(name, 0.0) for name in self._model.joints)

    def _trajectory(self, now: Angles, moves: Moves, straight: bool = False) -> Trajectory:
        targets = [self._all_joints(pose) for pose in moves.targets]
        joints = scaled(self._model.joints, *moves.scales)
        return trajectory(joints, self._all_joints(now), targets, straight=straight)
