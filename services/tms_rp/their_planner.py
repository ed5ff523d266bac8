"""The planner of the C++ system's version 6 as a maker of plans, where the site file says `planner: theirs`.

It is asked for plans only, which move nothing. What it would execute goes to the machine's controller directly, where
no permit and no stop of ours could end it; so its plans are checked as stored plans are, and pass our gateway when they
are executed. Goals become joint angles here, by our limits and kinematics: it is asked for the way between.
"""

from collections.abc import Sequence
from dataclasses import replace

from moveit_msgs.msg import RobotTrajectory
from tms_msg_rp.action import PlanPose, TmsRpExcavator
from tms_msg_rp.msg import TmsRpExcavatorJointValues
from tms_msg_rp.srv import TmsRpExcavatorParamSet
from trajectory_msgs.msg import JointTrajectory

from tms_machine.peer_forms import misfit
from tms_machine.reasons import NoReason
from tms_reason import wire
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_ros.client import Call
from tms_ros.goals import Outcome
from tms_ros.server import AnyGoal
from tms_rp.excavator import ACTION
from tms_rp.kind import Angles, Moves
from tms_rp.reasons import MotionCancelled, PlanMisses, PlannerAway, PlannerRefuses
from tms_runtime.app import App
from tms_runtime.fence import derived

GROUP = "manipulator"  # of joints, as its launch files call an excavator's arm
ACCEPT_LIMIT = 3.0  # s for it to answer a goal
PLAN_LIMIT = 30.0  # s for it to plan
CHECK_PERIOD = 0.2  # s between checks whether it is still there
CLOSE = 0.05  # rad from the asked angles at which its plans may end
LEAVE = -1.0  # in TmsRpExcavatorParamSet: a value stays as it is

PlanCall = Call[TmsRpExcavator.Result, TmsRpExcavator.Feedback]


class TheirPlanner:
    """Asks the planner of one excavator; `joints` are those of the arm."""

    def __init__(self, app: App, joints: Sequence[str]) -> None:
        self._ros, self._machine, self._joints = app.ros, app.machine, list(joints)
        self._form = str(app.site.file.forms.TmsRpExcavator)
        self._name = f"/{app.machine}/{ACTION}"
        self._peer = app.ros.peer(TmsRpExcavator, self._name)

    def way(self, goal: AnyGoal, request: PlanPose.Goal, moves: Moves) -> Moves:
        """The goal of `moves` along its plan.

        Raises:
            SubtaskFailed: PlannerAway, PlannerRefuses, PlanMisses, FormContradicted.
            RosError: it does not take the scales.
        """
        if not self._peer.ready():
            raise SubtaskFailed(PlannerAway(self._machine, self._name))
        why = misfit(self._ros, self._machine, ACTION, "TmsRpExcavator", self._form, servers=True)
        if why is not None:
            raise SubtaskFailed(why)
        self._scale(request)
        plans, before = list[JointTrajectory](), request.previous
        for target in moves.targets:
            plans.append(self._plan(goal, request.planning_group or GROUP, before, target))
            before = plans[-1]
        return replace(moves, targets=(), plans=tuple(plans))

    def _scale(self, request: PlanPose.Goal) -> None:
        settings = TmsRpExcavatorParamSet.Request(
            goal_position_tolerance=LEAVE, goal_orientation_tolerance=LEAVE, goal_joint_tolerance=CLOSE / 2,
            max_velocity_scaling_factor=request.velocity_scale,
            max_acceleration_scaling_factor=request.acceleration_scale, planning_time=LEAVE,
            num_planning_attempts=int(LEAVE),
        )  # fmt: skip
        answer = self._ros.call(TmsRpExcavatorParamSet, f"{self._name}_param_set", settings, ACCEPT_LIMIT)
        if not answer.success:
            raise SubtaskFailed(PlannerRefuses(self._machine, told(answer.message), 0))

    def _plan(self, goal: AnyGoal, group: str, before: JointTrajectory, target: Angles) -> JointTrajectory:
        """Its plan to joint angles, from the end of the plan before, or from where the arm is."""
        wanted = TmsRpExcavatorJointValues(joint_names=self._joints, joint_values=target)
        asked = TmsRpExcavator.Goal(
            command=TmsRpExcavator.Goal.CMD_PLAN_TO_JOINTS, planning_group=group, joint_values=wanted
        )
        if before.points:
            asked.previous_pose = [RobotTrajectory(joint_trajectory=before)]
        result = self._answer(goal, self._peer.send(asked, goal_id=derived(goal.uuid)))
        plan: JointTrajectory = result.plan.joint_trajectory
        if not result.success or not plan.points:
            raise SubtaskFailed(PlannerRefuses(self._machine, told(result.message), result.moveit_error_code))
        end = dict(zip(plan.joint_names, plan.points[-1].positions, strict=False))
        for joint, angle in zip(self._joints, target, strict=True):
            if not abs(end.get(joint, float("inf")) - angle) <= CLOSE:
                raise SubtaskFailed(PlanMisses(joint, end.get(joint, float("inf")), angle))
        return plan

    def _answer(self, goal: AnyGoal, call: PlanCall) -> TmsRpExcavator.Result:
        """Its answer; a cancel of our goal is passed on, and whatever it answers then moves nothing."""

        def ended() -> bool:
            return call.outcome is not None or goal.cancelled.is_set()

        goal.on_cancel = call.changed  # wakes the waits below
        call.wait_for(lambda: call.accepted or ended(), ACCEPT_LIMIT)
        waits = int(PLAN_LIMIT / CHECK_PERIOD)
        while call.accepted and waits > 0 and not call.wait_for(ended, CHECK_PERIOD) and not self._peer.left():
            waits -= 1
        if call.outcome is None:
            self._peer.cancel(call)
        if goal.cancelled.is_set():
            raise SubtaskFailed(MotionCancelled())
        if call.result is None or call.outcome not in (Outcome.SUCCEEDED, Outcome.ABORTED):
            raise SubtaskFailed(PlannerAway(self._machine, self._name))
        return call.result


def told(message: str) -> Reason:
    """What it says, in its own words."""
    return wire.of(message) or NoReason()
