"""The joint trajectory controller's action."""

from control_msgs.action import FollowJointTrajectory
from trajectory_msgs.msg import JointTrajectoryPoint

from tms_machine import stamps
from tms_machine.motion_messages import knots
from tms_machine.stamps import duration
from tms_sim.controller import Controller, TrajectoryMotion
from tms_sim.motion import MotionVerdict
from tms_sim.servers import ActionHandler


def trajectory_server(controller: Controller) -> ActionHandler:
    """FollowJointTrajectory on a controller."""

    def begin(request: FollowJointTrajectory.Goal) -> TrajectoryMotion:
        wanted, late = request.trajectory, stamps.seconds(request.goal_time_tolerance)
        return controller.begin(list(wanted.joint_names), knots(wanted), late)

    def refusal(request: FollowJointTrajectory.Goal) -> tuple[int, str] | None:
        return controller.refusal(list(request.trajectory.joint_names), knots(request.trajectory))

    def feedback(motion: TrajectoryMotion) -> FollowJointTrajectory.Feedback:
        arm = controller.arm
        since = max(0.0, arm.elapsed)  # s, it begins a dead time after the goal was accepted
        desired, actual = list(motion.reference.at(since)), arm.positions
        return FollowJointTrajectory.Feedback(
            joint_names=list(arm.joints),
            desired=JointTrajectoryPoint(positions=desired, time_from_start=duration(since)),
            actual=JointTrajectoryPoint(positions=actual, velocities=arm.velocities),
            error=JointTrajectoryPoint(positions=[d - a for d, a in zip(desired, actual, strict=True)]),
        )

    def result(_motion: TrajectoryMotion, verdict: MotionVerdict) -> FollowJointTrajectory.Result:
        return FollowJointTrajectory.Result(error_code=verdict.code, error_string=verdict.text)

    return ActionHandler("trajectory", FollowJointTrajectory, refusal, begin, controller.cancel, feedback, result)
