"""Every action of every kind of machine plans from plain joint angles, as the process `<machine>:rp` has them."""

import math

import pytest
from geometry_msgs.msg import Point, Pose, Quaternion
from tms_msg_rp.action import (
    Excavate,
    PlanPose,
    Release,
    TmsRpZx200ChangePose,
    TmsRpZx200ExcavateSimple,
    TmsRpZx200ReleaseSimple,
)
from tms_msg_rp.msg import TmsRpZx200PositionWithAngle
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_config.models import MachineModel
from tms_reason.errors import SubtaskFailed
from tms_rp.kind import PlanningAction
from tms_rp.kinds import load
from tms_rp.kinds.backhoe.linkage import ArmAngles
from tms_rp.reasons import OneTarget

NOW = (0.3, -0.5, 1.5, 0.4)  # rad
FACE = TmsRpZx200PositionWithAngle(position=Point(x=6.0, y=0.0, z=0.0), theta_w=2.0)
PLACE = TmsRpZx200PositionWithAngle(position=Point(x=5.0, y=2.0, z=3.5), theta_w=3.0)
ANGLES = JointTrajectory(
    joint_names=["swing_joint", "boom_joint"], points=[JointTrajectoryPoint(positions=[0.5, -0.6])]
)
REQUESTS = {
    TmsRpZx200ChangePose: TmsRpZx200ChangePose.Goal(trajectory=ANGLES),
    PlanPose: PlanPose.Goal(trajectory=ANGLES, velocity_scale=1.0, acceleration_scale=1.0),
    Excavate: Excavate.Goal(position_with_angle=FACE, depth=0.5),
    Release: Release.Goal(target_angle=0.2, position_with_angle=[PLACE]),
    TmsRpZx200ExcavateSimple: TmsRpZx200ExcavateSimple.Goal(position_with_angle=FACE),
    TmsRpZx200ReleaseSimple: TmsRpZx200ReleaseSimple.Goal(target_angle=0.2),
}


@pytest.mark.parametrize("action", load("backhoe").actions, ids=lambda action: action.name)
def test_an_action_plans_from_plain_angles(model: MachineModel, action: PlanningAction) -> None:
    kind = load("backhoe")
    moves = action.plan(kind.planner(model), NOW, REQUESTS[action.type])
    assert moves.targets and all(len(target) == len(kind.joints) for target in moves.targets)
    assert moves.targets[-1] != NOW


def test_the_cpp_systems_excavation_has_the_usual_figures(model: MachineModel) -> None:
    kind = load("backhoe")
    planner, actions = kind.planner(model), {action.name: action for action in kind.actions}
    simple = actions["excavate_simple"].plan(planner, NOW, TmsRpZx200ExcavateSimple.Goal(position_with_angle=FACE))
    goal = Excavate.Goal(position_with_angle=FACE)
    assert (goal.depth, goal.drag, goal.lift) == (1.0, 1.0, 0.5)
    assert simple == actions["excavate"].plan(planner, NOW, goal)


def test_the_bucket_is_emptied_over_one_place_at_most(model: MachineModel) -> None:
    kind = load("backhoe")
    (action,) = (one for one in kind.actions if one.name == "release")
    with pytest.raises(SubtaskFailed) as caught:
        action.plan(kind.planner(model), NOW, Release.Goal(position_with_angle=[PLACE, PLACE]))
    assert caught.value.reason == OneTarget(2)


def test_a_plan_begins_where_the_one_before_ends(model: MachineModel) -> None:
    kind = load("backhoe")
    (plan,) = (action for action in kind.actions if action.answers)
    before = JointTrajectory(
        joint_names=list(kind.joints), points=[JointTrajectoryPoint(positions=[1.0, -0.4, 1.0, 0.1])]
    )
    goal = PlanPose.Goal(previous=before, trajectory=ANGLES, velocity_scale=0.5, acceleration_scale=0.25)
    moves = plan.plan(kind.planner(model), NOW, goal)
    assert moves.begin == (1.0, -0.4, 1.0, 0.1) and moves.targets == ((0.5, -0.6, 1.0, 0.1),)
    assert moves.scales == (0.5, 0.25)


def test_a_pose_is_asked_for_by_angles_by_the_link_or_by_the_tip_and_in_sequences(model: MachineModel) -> None:
    kind = load("backhoe")
    planner, actions = kind.planner(model), {action.name: action for action in kind.actions}
    tip = planner.linkage.tip(ArmAngles(0.5, -0.6, 1.5, 0.4))
    level = tip.theta_w + planner.linkage.level  # pitch of the link
    turn = Quaternion(
        x=-math.sin(0.25) * math.sin(level / 2), y=math.cos(0.25) * math.sin(level / 2),
        z=math.sin(0.25) * math.cos(level / 2), w=math.cos(0.25) * math.cos(level / 2),
    )  # fmt: skip
    point = Point(x=tip.x, y=tip.y, z=tip.z)
    angles = [JointTrajectoryPoint(positions=[0.5, -0.6, 1.5, 0.4]), JointTrajectoryPoint(positions=list(NOW))]
    by_tip = [TmsRpZx200PositionWithAngle(position=point, theta_w=tip.theta_w), PLACE]
    goals = (
        {"trajectory": JointTrajectory(joint_names=list(kind.joints), points=angles)},
        {"pose_sequence": [Pose(position=point, orientation=turn)] * 2},
        {"position_with_angle_sequence": by_tip},
    )
    for given in goals:
        for name, goal in (("change_pose", TmsRpZx200ChangePose.Goal), ("plan_pose", PlanPose.Goal)):
            moves = actions[name].plan(planner, NOW, goal(**given))
            assert len(moves.targets) == 2 and moves.targets[0] == pytest.approx((0.5, -0.6, 1.5, 0.4), abs=1e-6)
