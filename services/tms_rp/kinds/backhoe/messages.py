"""Goals for excavators, from ROS messages."""

from geometry_msgs.msg import Pose
from tms_msg_rp.action import Excavate, PlanPose, Release, TmsRpZx200ChangePose
from tms_msg_rp.msg import TmsRpZx200PositionWithAngle

from tms_reason.errors import SubtaskFailed
from tms_rp.kinds.backhoe.goals import ChangePose, Dig, Emptying, LinkGoal, TipGoal, joint_goal
from tms_rp.reasons import OneTarget


def change_pose(request: TmsRpZx200ChangePose.Goal | PlanPose.Goal) -> ChangePose:
    """Goal of a TmsRpZx200ChangePose or PlanPose request.

    Raises:
        SubtaskFailed: lists of the trajectory do not fit.
    """
    names = request.trajectory.joint_names
    return ChangePose(
        joints=tuple(joint_goal(names, point.positions) for point in request.trajectory.points),
        links=tuple(_link(pose) for pose in request.pose_sequence),
        tips=tuple(tip(one) for one in request.position_with_angle_sequence),
    )


def tip(message: TmsRpZx200PositionWithAngle) -> TipGoal:
    """Goal of a TmsRpZx200PositionWithAngle."""
    at = message.position
    return TipGoal(at.x, at.y, at.z, message.theta_w, message.offset)


def dig(request: Excavate.Goal) -> Dig:
    """Goal of an Excavate request."""
    return Dig(tip(request.position_with_angle), request.depth, request.drag, request.lift)


def emptying(request: Release.Goal) -> Emptying:
    """Goal of a Release request.

    Raises:
        SubtaskFailed: OneTarget.
    """
    places = [tip(one) for one in request.position_with_angle]
    if len(places) > 1:
        raise SubtaskFailed(OneTarget(len(places)))
    return Emptying(request.target_angle, *places)


def _link(pose: Pose) -> LinkGoal:
    at, turn = pose.position, pose.orientation
    return LinkGoal(at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w)
