"""Trajectories as ROS messages."""

from array import array

from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_rp.trajectory import Trajectory


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
