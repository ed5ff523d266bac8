"""Ranges that joints must not leave on a planned way."""

from trajectory_msgs.msg import JointTrajectory

from tms_machine.reasons import NotHonoured, PathLeavesConstraint
from tms_reason.reason import Reason


def left(plan: JointTrajectory, joint: str, low: float, high: float) -> Reason | None:
    """Why a plan does not keep a joint within its range [rad]; nor can a plan that does not have the joint."""
    names = list(plan.joint_names)
    if joint not in names:
        return NotHonoured((joint,))
    angles = (point.positions[names.index(joint)] for point in plan.points)
    outside = next((angle for angle in angles if not low <= angle <= high), None)
    return None if outside is None else PathLeavesConstraint(joint, outside, low, high)
