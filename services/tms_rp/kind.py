"""The parts with which a kind of machine makes its motions plannable; each folder of `kinds` has one as its KIND."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from trajectory_msgs.msg import JointTrajectory

from tms_config.models import MachineModel
from tms_reason.reason import Reason
from tms_rp.trench import Trench

Angles = tuple[float, ...]  # rad, of the joints of the kind in their order


@dataclass(frozen=True)
class Through:
    """How a motion passes its targets without a stop.

    `least`: how long [s] the line to each takes at least. `free`: the first target may be reached by any way; the lines
    to all others are part of the goal. `trench`: where the tool digs; elsewhere, and without it, nothing touches the
    ground.
    `held`: what a pose on a way becomes so that the tool spills nothing, None if it would; without it, it carries
    nothing.
    """

    least: tuple[float, ...]
    free: bool = True
    trench: Trench | None = None
    held: Callable[[Angles], Angles | None] | None = None

    def last(self, count: int) -> "Through":
        """For the last so many targets alone."""
        all_left = count == len(self.least)
        return replace(self, least=self.least[len(self.least) - count :], free=self.free and all_left)


@dataclass(frozen=True)
class Moves:
    """Joint targets one after another, and what the planner changed in the goal.

    Each is reached at rest; with `through`, only the last one.
    """

    targets: tuple[Angles, ...]
    notes: tuple[Reason, ...] = ()
    begin: Angles | None = None  # where the motion begins; None: where the arm is now
    plans: tuple[JointTrajectory, ...] = ()  # stored plans, instead of targets
    scales: tuple[float, float] = (1.0, 1.0)  # shares of the limits of velocity, and of acceleration and jerk
    through: Through | None = None
    broken_off: bool = False  # whether the plans may be: they go on where the arm stands on their path then

    def rest(self, count: int) -> "Moves":
        """What is left of the goal when so many targets are, from where the arm is then."""
        through = None if self.through is None else self.through.last(count)
        return replace(self, targets=self.targets[len(self.targets) - count :], begin=None, through=through)


@dataclass(frozen=True)
class Way:
    """Joint targets one after another up to the one that a goal asks for, and how people call that; None: straight."""

    targets: tuple[Angles, ...]
    name: Reason | None = None


@dataclass(frozen=True)
class Manners:
    """How a kind of machine gets around something. All poses are angles of the joints of the kind, all bounds rad."""

    ways: Callable[[MachineModel, Angles, Angles], Iterable[Way]]  # from a pose to a target, the best first
    flowing: Callable[[MachineModel, Angles, Angles], Iterable[Way]]  # the same for motions that do not stop on the way
    lifts: Callable[[MachineModel, Angles], Iterable[Angles]]  # the pose and others above it, each higher
    targets: Callable[[MachineModel, Angles, Angles], Sequence[Angles]]  # the target, and poses that are as good
    # For a search between poses: least and most of each joint.
    bounds: Callable[[MachineModel, Sequence[Angles]], Sequence[tuple[float, float]]]


@dataclass(frozen=True)
class PlanningAction:
    """One served action: how its goal becomes moves, and whether they are executed.

    `plan` gets the planner, the present angles and the goal; it raises SubtaskFailed with a reason. With `answers` the
    result has the trajectory as its `plan`.
    """

    name: str
    type: Any  # all have the same result and feedback
    plan: Callable[[Any, Angles, Any], Moves]
    moves: bool
    answers: bool = False


@dataclass(frozen=True)
class MachineKind:
    """A kind of machine whose motions are planned."""

    joints: tuple[str, ...]  # joints that goals move
    planner: Callable[[MachineModel], Any]  # raises ConfigError: the model is not of this kind
    actions: tuple[PlanningAction, ...]
    manners: Manners
