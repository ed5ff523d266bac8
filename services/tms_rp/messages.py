"""ROS messages of planning goals and trajectories, to and from the planner's own types."""

from array import array

from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from geometry_msgs.msg import Pose
from tms_msg_rp.action import TmsRpZx200ChangePose
from tms_msg_rp.msg import TmsRpZx200PositionWithAngle
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_rp.goals import ChangePose, LinkGoal, TipGoal, joint_goal
from tms_rp.trajectory import Trajectory


def change_pose(request: TmsRpZx200ChangePose.Goal) -> ChangePose:
    """Goal of a TmsRpZx200ChangePose request.

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


def _link(pose: Pose) -> LinkGoal:
    at, turn = pose.position, pose.orientation
    return LinkGoal(at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w)


def follow(made: Trajectory) -> FollowJointTrajectory.Goal:
    """The goal for a joint trajectory controller."""
    points = [
        JointTrajectoryPoint(
            positions=array("d", sample.positions),
            velocities=array("d", sample.velocities),
            accelerations=array("d", sample.accelerations),
            time_from_start=_duration(sample.time),
        )
        for sample in made.samples
    ]
    return FollowJointTrajectory.Goal(trajectory=JointTrajectory(joint_names=list(made.names), points=points))


def _duration(seconds: float) -> Duration:
    sec, nanosec = divmod(round(seconds * 1e9), 1_000_000_000)
    return Duration(sec=sec, nanosec=nanosec)
