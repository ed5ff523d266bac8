"""Goals of TmsRpExcavator in the terms of our planner."""

from typing import Any

from moveit_msgs.msg import Constraints
from tms_msg_rp.action import PlanPose, TmsRpExcavator
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_machine.joint_ranges import left
from tms_machine.reasons import NotHonoured
from tms_reason.reason import Reason
from tms_rp.excavator_settings import Settings
from tms_rp.reasons import MoveOf, Planned, Succeeded


def plan_goal(request: TmsRpExcavator.Goal, settings: Settings) -> PlanPose.Goal:
    """A goal that plans: to the pose of bucket_end_link, or to joint angles; those left out stay."""
    goal = PlanPose.Goal(
        velocity_scale=settings.max_velocity_scaling_factor,
        acceleration_scale=settings.max_acceleration_scaling_factor,
        orientation_tolerance=settings.goal_orientation_tolerance,
    )
    if request.previous_pose:
        goal.previous = request.previous_pose[-1].joint_trajectory
    if request.command == request.CMD_PLAN_TO_POSE:
        goal.pose_sequence = [request.pose]
    else:
        wanted = request.joint_values
        point = JointTrajectoryPoint(positions=wanted.joint_values)
        goal.trajectory = JointTrajectory(joint_names=wanted.joint_names, points=[point])
    return goal


def stored_plans(request: Any) -> list[JointTrajectory]:
    """The plans to execute, in either form of the goal; those without points are left out."""
    given = request.plans if hasattr(request, "plans") else [request.plan]
    return [one.joint_trajectory for one in given if one.joint_trajectory.points]


def not_kept(constraints: Constraints) -> Reason | None:
    """Which constraints our planner cannot keep: it checks the angles of joints on its way, and nothing else."""
    others = ("position_constraints", "orientation_constraints", "visibility_constraints")
    found = tuple(name for name in others if getattr(constraints, name))
    return NotHonoured(found) if found else None


def leaves(constraints: Constraints, plan: JointTrajectory) -> Reason | None:
    """Which constraint a plan does not keep."""
    for one in constraints.joint_constraints:
        low, high = one.position - one.tolerance_below, one.position + one.tolerance_above
        if (why := left(plan, one.joint_name, low, high)) is not None:
            return why
    return None


def progress_of(state: Reason) -> float:
    """The share that is done, 0 to 1, as far as a state tells it."""
    if isinstance(state, Planned | Succeeded):
        return 1.0
    found = state.find(MoveOf)
    return (found.number - 1 + found.percent / 100) / found.count if isinstance(found, MoveOf) else 0.0
