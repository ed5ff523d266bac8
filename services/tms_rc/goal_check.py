"""What a goal asks of the machine: whether that is within its limits, and the motion that must be seen."""

from typing import Any

from tms_config.config import Site
from tms_decision.gateway.events import Reference, Turn
from tms_decision.gateway.state import Gateway
from tms_machine.border import MotionAction
from tms_machine.stamps import seconds
from tms_rc import limits
from tms_rc.motion_goals import numbers, point_of, poses_of
from tms_reason.reason import Reason


class GoalCheck:
    """Checks goals of one machine against its model."""

    def __init__(self, site: Site, machine: str) -> None:
        self._model, self._dump_returns = site.model_of(machine), site.border(machine).dump_returns

    def problem(self, motion: MotionAction, request: Any, gateway: Gateway) -> Reason | None:
        """Why the machine must not do what a goal asks, from where it is now."""
        present = gateway.watch.positions
        if hasattr(request, "trajectory"):
            wanted = request.trajectory
            points = [point.positions for point in wanted.points]
            return limits.problem(self._model, wanted.joint_names, points, present) or limits.pace_problem(
                self._model, wanted.joint_names, [point_of(point) for point in wanted.points], present,
                gateway.facts.speed,
            )  # fmt: skip
        if hasattr(request, "target_angle"):
            return limits.angle_problem(self._model, motion.field, request.target_angle, present)
        return limits.pose_problem([numbers(stamped.pose) for stamped in poses_of(request)])

    def motion(self, motion: MotionAction, request: Any) -> Reference | Turn | None:
        """The motion of the joints that a goal asks for; None where it cannot be foretold."""
        if hasattr(request, "trajectory"):
            wanted = request.trajectory
            points = [(seconds(point.time_from_start), point.positions) for point in wanted.points]
            return Reference(tuple(wanted.joint_names), points)
        joint = self._model.turned(motion.field) if hasattr(request, "target_angle") else None
        if joint is None or self._dump_returns:
            return None
        limits_of = self._model.joints[joint]
        return Turn(joint, float(request.target_angle), limits_of.velocity, limits_of.acceleration)

    def escaped(self, gateway: Gateway, start: dict[str, float]) -> Reason | None:
        """Which joint has left its limits, and is further out than at the start of the goal."""
        return limits.escaped(self._model, gateway.watch.positions, start)
