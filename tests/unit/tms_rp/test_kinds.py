"""Every action of every kind of machine plans from plain joint angles, as the process `<machine>:rp` has them."""

import pytest
from geometry_msgs.msg import Point
from tms_msg_rp.action import TmsRpZx200ChangePose, TmsRpZx200ExcavateSimple, TmsRpZx200ReleaseSimple
from tms_msg_rp.msg import TmsRpZx200PositionWithAngle
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_config.models import MachineModel
from tms_rp.kind import PlanningAction
from tms_rp.kinds import load

NOW = (0.3, -0.5, 1.5, 0.4)  # rad
FACE = TmsRpZx200PositionWithAngle(position=Point(x=6.0, y=0.0, z=0.0), theta_w=2.0)
REQUESTS = {
    TmsRpZx200ChangePose: TmsRpZx200ChangePose.Goal(
        trajectory=JointTrajectory(
            joint_names=["swing_joint", "boom_joint"], points=[JointTrajectoryPoint(positions=[0.5, -0.6])]
        )
    ),
    TmsRpZx200ExcavateSimple: TmsRpZx200ExcavateSimple.Goal(position_with_angle=FACE),
    TmsRpZx200ReleaseSimple: TmsRpZx200ReleaseSimple.Goal(target_angle=0.2),
}


@pytest.mark.parametrize("action", load("backhoe").actions, ids=lambda action: action.name)
def test_an_action_plans_from_plain_angles(model: MachineModel, action: PlanningAction) -> None:
    kind = load("backhoe")
    moves = action.plan(kind.planner(model), NOW, REQUESTS[action.type])
    assert moves.targets and all(len(target) == len(kind.joints) for target in moves.targets)
    assert moves.targets[-1] != NOW
