"""A goal to drive is refused where its poses are no places, whatever the kind of the goal."""

import math
from types import SimpleNamespace
from typing import Any, cast

import pytest
from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import FollowPath, FollowWaypoints, NavigateThroughPoses, NavigateToPose
from nav_msgs.msg import Path
from tms_msg_rp.action import TmsRpBulldozerBlade

from tms_config.config import CONFIGS, load_site
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_decision.gateway.state import Gateway
from tms_machine.border import MOTIONS, motions
from tms_rc.goal_check import GoalCheck
from tms_rc.reasons import AnglesOnly, AtJoint, AtPose, NoNumber, NoPose, WrongLength
from tms_reason.reason import Reason

SITE = load_site("physx")
CHECK = GoalCheck(SITE, "zx200")
STANDS = cast(Gateway, SimpleNamespace(watch=SimpleNamespace(positions={})))


def pose(x: float) -> PoseStamped:
    found = PoseStamped()
    found.pose.position.x = x
    return found


def problem(goal: Any) -> Reason | None:
    (motion,) = (one for one in MOTIONS if isinstance(goal, one.type.Goal))
    return CHECK.problem(motion, goal, STANDS)


@pytest.mark.parametrize("kind", [FollowWaypoints, NavigateThroughPoses, FollowPath])
def test_several_poses(kind: Any) -> None:
    def goal(*poses: PoseStamped) -> Any:
        return kind.Goal(path=Path(poses=list(poses))) if kind is FollowPath else kind.Goal(poses=list(poses))

    assert problem(goal(pose(1.0), pose(2.0))) is None
    assert problem(goal()) == NoPose()
    assert problem(goal(pose(1.0), pose(math.nan))) == AtPose(1, NoNumber())


def test_one_pose() -> None:
    assert problem(NavigateToPose.Goal(pose=pose(1.0))) is None
    assert problem(NavigateToPose.Goal(pose=pose(math.inf))) == AtPose(0, NoNumber())


def test_a_path_is_a_motion_and_planning_one_is_not() -> None:
    served = {one.served for one in motions(SITE.border("zx200"))}
    assert "follow_path" in served
    assert "compute_path_to_pose" not in served


def test_a_blade_goes_to_angles_inside_its_limits() -> None:
    model = parse(CONFIGS / "machines" / "d37pxi.yaml", MachineModel)
    check = GoalCheck(cast(Any, SimpleNamespace(model_of=lambda _: model, border=lambda _: model.borders["sim"])), "d")
    (motion,) = (one for one in motions(model.borders["sim"]) if one.type is TmsRpBulldozerBlade)

    def asked(*angles: float, **more: Any) -> Reason | None:
        names = ["lift_joint", "tilt_joint", "angle_joint"]
        goal = TmsRpBulldozerBlade.Goal(joint_name=names, goal_position=list(angles), **more)
        assert check.motion(motion, goal) is None
        return check.problem(motion, goal, STANDS)

    assert asked(-0.3, 0.0, 0.1) is None
    beyond = asked(-0.5, 0.0, 0.0)
    assert isinstance(beyond, AtJoint) and beyond.joint == "lift_joint"
    wrong = asked(-0.3)
    assert wrong is not None and wrong.find(WrongLength) is not None
    assert asked(-0.3, 0.0, 0.0, control_type=TmsRpBulldozerBlade.Goal.VELOCITY) == AnglesOnly()
