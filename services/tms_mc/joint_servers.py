"""The actions that move joints: a trajectory of all, or one joint to an angle."""

import math
from collections.abc import Callable, Sequence
from typing import Any

from com3_msgs.action import SetDumpAngle, SetSwingAngle
from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTolerance
from trajectory_msgs.msg import JointTrajectoryPoint

from tms_config.clock import sleep
from tms_config.models import TURNED
from tms_control.arm_motion import ArmMotion, Tolerances
from tms_control.reference_trajectory import refusal
from tms_control.turning import turning
from tms_control.verdict import Ending
from tms_interfaces.generated import ActionType
from tms_machine import stamps
from tms_machine.motion_messages import knots
from tms_machine.stamps import duration
from tms_mc.guard import Guard
from tms_mc.joints import Joints
from tms_mc.reasons import JointLimit, NoAngle, Stopped
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ros.goals import Ended, Outcome
from tms_ros.server import AnyGoal

FEEDBACK = 0.1  # s
NOT_MOVED = -1  # control_msgs INVALID_GOAL
TURNS: dict[str, type[SetDumpAngle | SetSwingAngle]] = {
    "set_dump_angle": SetDumpAngle,
    "set_swing_angle": SetSwingAngle,
}


class JointServers:
    """Serves the joint actions of one machine."""

    def __init__(self, joints: Joints, guard: Guard) -> None:
        self._joints, self._guard = joints, guard

    # FollowJointTrajectory

    def refuse_trajectory(self, request: FollowJointTrajectory.Goal) -> Reason | None:
        """Why a trajectory is refused."""
        wrong = refusal(self._joints.arm.joints, list(request.trajectory.joint_names), knots(request.trajectory))
        return None if wrong is None else wrong[1]

    def follow(self, goal: AnyGoal) -> Ended[FollowJointTrajectory.Result]:
        """Follow a trajectory to its end."""
        names, points = list(goal.request.trajectory.joint_names), knots(goal.request.trajectory)

        def begin() -> ArmMotion:
            return self._joints.begin(names, points, _tolerances(goal.request))

        verdict = self._run(goal, begin, self._progress)
        if isinstance(verdict, Reason):
            result = FollowJointTrajectory.Result(error_code=NOT_MOVED, error_string=to_line(verdict))
            return Outcome.ABORTED, result
        why = "" if verdict.reason is None else to_line(verdict.reason)
        result = FollowJointTrajectory.Result(error_code=verdict.code, error_string=why)
        return Outcome[verdict.ending.value], result

    def _progress(self, motion: ArmMotion) -> FollowJointTrajectory.Feedback:
        since, now = max(0.0, self._joints.since(motion)), self._joints.positions
        desired, actual = list(motion.reference.at(since)), list(now.values())
        return FollowJointTrajectory.Feedback(
            joint_names=list(now),
            desired=JointTrajectoryPoint(positions=desired, time_from_start=duration(since)),
            actual=JointTrajectoryPoint(positions=actual),
            error=JointTrajectoryPoint(positions=[d - a for d, a in zip(desired, actual, strict=True)]),
        )

    # SetDumpAngle, SetSwingAngle

    def turn(
        self, field: str
    ) -> tuple[ActionType[Any, Any, Any], Callable[[AnyGoal], Ended[Any]], Callable[[Any], Reason | None]]:
        """The type, the worker and the check of the action that brings one joint to an angle."""
        action, joints = TURNS[field], self._joints.arm.joints
        joint = next(name for name in TURNED[field] if name in joints)

        def refuse(request: Any) -> Reason | None:
            if not math.isfinite(request.target_angle):
                return NoAngle(joint)
            broken = joints[joint].violation(request.target_angle)
            return None if broken is None else JointLimit(joint, broken)

        def run(goal: AnyGoal) -> Ended[Any]:
            now, angle = self._joints.positions, float(goal.request.target_angle)
            if joints[joint].min is None and joints[joint].max is None:
                angle = now[joint] + math.remainder(angle - now[joint], math.tau)

            def begin() -> ArmMotion:
                return self._joints.begin(list(joints), turning(joints, now, joint, angle), Tolerances())

            def progress(_motion: ArmMotion) -> Any:
                return action.Feedback(current_error=angle - self._joints.positions[joint])

            verdict = self._run(goal, begin, progress)
            if isinstance(verdict, Reason):
                return Outcome.ABORTED, action.Result(success=False)
            return Outcome[verdict.ending.value], action.Result(success=verdict.ending is Ending.SUCCEEDED)

        return action, run, refuse

    def _run(self, goal: AnyGoal, begin: Callable[[], ArmMotion], progress: Callable[[ArmMotion], Any]) -> Any:
        """Move to the end of a goal; returns its verdict, or why it could not begin."""
        with self._guard.working_for(goal):
            if (kept := self._guard.wait(goal)) is not None:
                return kept
            motion = begin()
            goal.on_cancel = lambda: self._joints.stop(Stopped())
            if goal.cancelled.is_set():  # the request came before the motion began
                goal.on_cancel()
            while motion.verdict is None and not self._guard.closing:
                sleep(FEEDBACK)
                goal.publish(progress(motion))
            return motion.verdict or Stopped()


def _tolerances(request: FollowJointTrajectory.Goal) -> Tolerances:
    return Tolerances(
        _positions(request.path_tolerance),
        _positions(request.goal_tolerance),
        {one.name: one.velocity for one in request.goal_tolerance},
        stamps.seconds(request.goal_time_tolerance),
    )


def _positions(tolerances: Sequence[JointTolerance]) -> dict[str, float]:
    return {one.name: one.position for one in tolerances}
