"""Capability of excavators: goals for the arm, planned by the machine's TMS_RP."""

from collections.abc import Sequence
from typing import Protocol, TypeVar

from geometry_msgs.msg import Point, Pose
from tms_msg_rp.action import Excavate, ExecutePlans, PlanPose, Release, TmsRpZx200ChangePose
from tms_msg_rp.msg import TmsRpZx200PositionWithAngle
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_interfaces.generated import ActionType, G, Message, R
from tms_kit.acting import Acting, Progress
from tms_machine.reasons import NoReason
from tms_reason import wire


class Feedback(Message, Protocol):
    """Feedback of the planner's actions."""

    state: str


Telling = TypeVar("Telling", bound=Feedback)


class Digging(Acting):
    """An arm with boom, arm and bucket. With `plan_only` the motion is only planned, and the arm does not move."""

    def change_pose(
        self,
        progress: Progress,
        *,
        joints: dict[str, float] | None = None,
        pose: Pose | None = None,
        tip: tuple[float, float, float, float] | None = None,
        plan_only: bool = False,
    ) -> None:
        """Move the arm: to joint angles [rad], to a Pose of the bucket tip, or to x, y, z [m], theta_w [rad].

        Poses are in base_link; exactly one of the three is given. Joints left out stay where they are.
        """
        goal = TmsRpZx200ChangePose.Goal()
        if joints is not None:
            goal.trajectory = _angles(joints)
        if pose is not None:
            goal.pose_sequence = [pose]
        if tip is not None:
            goal.position_with_angle_sequence = [_tip(tip[:3], tip[3])]
        self._plan(TmsRpZx200ChangePose, "change_pose", goal, progress, plan_only)

    def excavate(
        self,
        progress: Progress,
        tip: tuple[float, float, float],
        theta_w: float,
        offset: float,
        plan_only: bool = False,
        **shape: float,
    ) -> None:
        """Dig at x, y, z [m, base_link], reaching `offset` [m] further out, bucket at theta_w [rad], in one motion.

        `shape`: depth below z, drag towards the machine, lift above the ground at the end [m]; else those of Excavate.
        """
        goal = Excavate.Goal(position_with_angle=_tip(tip, theta_w, offset), **shape)
        self._plan(Excavate, "excavate", goal, progress, plan_only)

    def release_soil(self, progress: Progress, target_angle: float, place: Sequence[float] = ()) -> None:
        """Open the bucket to `target_angle` [rad], over x, y, z [m, base_link], theta_w [rad] or where the arm is."""
        goal = Release.Goal(target_angle=target_angle)
        if place:
            goal.position_with_angle = [_tip(place[:3], place[3])]
        self._plan(Release, "release", goal, progress, False)

    def plan_pose(
        self,
        progress: Progress,
        to: dict[str, float] | tuple[float, float, float, float],
        previous: JointTrajectory | None,
        velocity_scale: float,
        acceleration_scale: float,
        group: str = "",
    ) -> JointTrajectory:
        """A plan to joint angles [rad], or to x, y, z [m, base_link], theta_w [rad]; nothing moves.

        It begins at the end of `previous`, else where the arm is. Scales are shares of the joints' limits. `group`: the
        arm's name in the C++ system's planner, where that one plans in place of ours.
        """
        goal = PlanPose.Goal(velocity_scale=velocity_scale, acceleration_scale=acceleration_scale, planning_group=group)
        if isinstance(to, dict):
            goal.trajectory = _angles(to)
        else:
            goal.position_with_angle_sequence = [_tip(to[:3], to[3])]
        if previous is not None:
            goal.previous = previous
        return self._plan(PlanPose, "plan_pose", goal, progress, False).plan

    def execute_plans(self, progress: Progress, plans: Sequence[JointTrajectory]) -> None:
        """Move along plans, one behind the other, as one trajectory."""
        self._plan(ExecutePlans, "execute_plans", ExecutePlans.Goal(plans=list(plans)), progress, False)

    def _plan(
        self, action_type: ActionType[G, R, Telling], what: str, goal: G, progress: Progress, plan_only: bool
    ) -> R:
        action = f"tms_rp_{self._model_name}_{what}" + ("_plan" if plan_only else "")
        return self.act(action_type, action, goal, lambda feedback: progress(wire.of(feedback.state) or NoReason()))


def _angles(joints: dict[str, float]) -> JointTrajectory:
    point = JointTrajectoryPoint(positions=list(joints.values()))
    return JointTrajectory(joint_names=list(joints), points=[point])


def _tip(position: Sequence[float], theta_w: float, offset: float = 0.0) -> TmsRpZx200PositionWithAngle:
    x, y, z = position
    return TmsRpZx200PositionWithAngle(position=Point(x=x, y=y, z=z), theta_w=theta_w, offset=offset)
