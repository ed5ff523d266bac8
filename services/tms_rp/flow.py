"""Plans for motions that pass their targets without a stop."""

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from tms_config.models import MachineModel
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.blending import blended
from tms_rp.clearance import Clearance
from tms_rp.kind import Angles, MachineKind, Moves, Through, Way
from tms_rp.plan import Plan
from tms_rp.plans import scaled
from tms_rp.reasons import Around, Collision, Ground, NoWayRound
from tms_rp.scene import Scene
from tms_rp.trajectory import Joints, Trajectory, trajectory

MORE = 2  # lifts of the kind by which an arm comes further out of the ground than it must: corners are rounded

AllJoints = Callable[[Angles], Joints]
FindWay = Callable[[Angles, Angles, Scene, Reason], Way]


@dataclass(frozen=True)
class _Course:
    """Poses that a motion goes through from the one now, and how long the line to each of them takes at least [s]."""

    poses: tuple[Angles, ...]
    least: tuple[float, ...]
    name: Reason | None = None


class Flow:
    """Plans for one machine.

    `whole`: a pose of the kind's joints as one of all joints. `find`: a way with stops between two poses in a scene.
    """

    def __init__(
        self, model: MachineModel, kind: MachineKind, clearance: Clearance, whole: AllJoints, find: FindWay
    ) -> None:
        self._model, self._kind, self._clearance, self._whole, self._find = model, kind, clearance, whole, find
        answers = [model.response[name] for name in kind.joints]
        soonest = min(one.dead_time + one.lag for one in answers)
        self._late = self._whole(tuple(one.dead_time + one.lag - soonest for one in answers))

    def plan(self, now: Angles, moves: Moves, through: Through, scene: Scene) -> Plan:
        """The trajectory through all targets of `moves`, above the ground but for its trench.

        Nothing is touched on it, nor when each joint is late by its own dead time and lag: some controllers make up for
        these, others do not.

        Raises:
            SubtaskFailed: Collision: what the goal itself asks for is not free. NoWayRound. NoTrajectory, LimitsLeft.
        """
        trench = through.trench
        grounded = scene.with_ground() if trench is None else trench.around(scene)
        up = self._up(now, through, scene.bare().with_ground() if trench is None else trench.around(scene.bare()))
        why: Reason | None = None
        for course in self._courses((now, *up), moves, through, grounded):
            made = self._timed((now, *course.poses), course.least, moves)
            refused = self._refusal(made, grounded, made.stops[0] if up else 0.0)
            if refused is None:
                return self._plan(made, course.poses, _notes(moves, course.name, why), moves)
            if why is None:
                why = self._own_refusal(moves, through, grounded, refused, made)
        assert why is not None
        return self._with_stops((now, *up), moves, through, (scene, grounded), why)

    def _courses(self, begin: Sequence[Angles], moves: Moves, through: Through, scene: Scene) -> Iterator[_Course]:
        """Straight from target to target; then the manners of the kind, if the first one may be reached by any way."""
        yield _course(begin[1:], (moves.targets[0],), moves, through)
        if not through.free:
            return
        for way in self._kind.manners.flowing(self._model, begin[-1], moves.targets[0]):
            between = _held(way.targets[:-1], through)
            with self._clearance.looking(scene) as view:
                free = all(view.free(self._whole(pose)) for pose in between)  # costs little
            if free and len(between) == len(way.targets) - 1:
                found = _course(begin[1:], (*between, way.targets[-1]), moves, through)
                yield replace(found, name=way.name)

    def _up(self, now: Angles, through: Through, ground: Scene) -> tuple[Angles, ...]:
        """A pose above the one now if the arm is in the ground and goes elsewhere: it must not plough."""
        with self._clearance.looking(ground) as view:
            if not through.free or view.free(self._whole(now)):
                return ()
            found = (one for one in self._kind.manners.lifts(self._model, now) if view.free(self._whole(one)))
            return _held([next(itertools.islice(found, MORE, None), now)], through)

    def _timed(self, poses: Sequence[Angles], least: Sequence[float], moves: Moves) -> Trajectory:
        return blended(scaled(self._model.joints, *moves.scales), [self._whole(pose) for pose in poses], least)

    def _refusal(self, made: Trajectory, scene: Scene, up: float = 0.0) -> Reason | None:
        """Why a motion is not free.

        `up`: when [s] it is out of the ground in which it begins; else a contact with it might last.
        """
        late = made.lagging(self._late)
        parts = [(made, 0.0), (late, 0.0)] + [(made, up), (late, up + max(self._late))] * (up > 0)
        try:
            for part, begin in parts:
                self._clearance.check(part.since(begin), scene)
        except SubtaskFailed as error:
            return error.reason
        return None

    def _own_refusal(
        self, moves: Moves, through: Through, scene: Scene, refused: Reason, straight: Trajectory
    ) -> Reason:
        """Why the straight way was refused; raised, if another way to the first target does not help."""
        if not through.free:
            raise SubtaskFailed(refused)
        own = self._timed(moves.targets, through.least[1:], moves)
        why = self._refusal(own, scene)
        if why is None:
            return refused
        if isinstance(why, Collision):  # it is told when that is on the straight way
            begin = straight.stops[-len(moves.targets)]
            why = Collision(**{**why.args, "seconds": why.seconds + begin})
        raise SubtaskFailed(why)

    def _with_stops(
        self, begin: Sequence[Angles], moves: Moves, through: Through, scenes: tuple[Scene, Scene], why: Reason
    ) -> Plan:
        """With stops on the way to the first target; the rest as ever."""
        scene, grounded = scenes
        if through.held is not None:
            raise SubtaskFailed(NoWayRound(why))
        way = self._find(begin[-1], moves.targets[0], scene, why)
        course = _course(begin[1:], way.targets, moves, through)
        first = len(course.poses) - len(moves.targets) + 1
        joints = scaled(self._model.joints, *moves.scales)
        whole = [self._whole(pose) for pose in (begin[0], *course.poses)]
        made = trajectory(joints, whole[0], whole[1 : first + 1], straight=True)
        if len(moves.targets) > 1:
            made = made.then(blended(joints, whole[first:], course.least[first:]))
        refused = self._refusal(made, grounded)
        if refused is not None:
            raise SubtaskFailed(NoWayRound(refused))
        return self._plan(made, course.poses, _notes(moves, way.name, why), moves)

    def _plan(self, made: Trajectory, poses: Sequence[Angles], notes: tuple[Reason, ...], moves: Moves) -> Plan:
        count = len(moves.targets)
        return Plan(made, notes, replace(moves, targets=tuple(poses[-count:])), made.stops[-count:])


def _notes(moves: Moves, name: Reason | None, why: Reason | None) -> tuple[Reason, ...]:
    """What people should know; that it swings before it goes down to the ground is the usual."""
    if name is None or why is None or why.find(Ground) is not None:
        return moves.notes
    return (*moves.notes, Around(name, why))


def _held(poses: Sequence[Angles], through: Through) -> tuple[Angles, ...]:
    """The poses without spilling what the tool carries; those are left out in which it would."""
    held = map(through.held, poses) if through.held is not None else poses
    return tuple(pose for pose in held if pose is not None)


def _course(up: Sequence[Angles], way: Sequence[Angles], moves: Moves, through: Through) -> _Course:
    """Up, a way to the first target, then the others; where the way ends whole turns away, they are turned, too."""
    turned = [a - b for a, b in zip(way[-1], moves.targets[0], strict=True)]
    others = [tuple(a + b for a, b in zip(one, turned, strict=True)) for one in moves.targets[1:]]
    before = len(up) + len(way) - 1
    return _Course((*up, *way, *others), (*(0.0,) * before, *through.least))
