"""A check plans as a goal would, tells how near it comes to what, and whether a refusal lasts."""

import math
from typing import Any

import numpy as np
import pytest
from tms_msg_rp.action import TmsRpZx200ChangePose
from tms_msg_rp.srv import CheckMotion
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_config.config import CONFIGS
from tms_config.models import Box, MachineModel
from tms_config.yaml_file import parse
from tms_reason import wire
from tms_ros.packing import pack
from tms_rp.checks import MotionChecks
from tms_rp.kind import Angles, PlanningAction
from tms_rp.kinds import load
from tms_rp.kinds.backhoe.planner import Backhoe
from tms_rp.plan import Plan
from tms_rp.reasons import Around, Between, Part, PartOf
from tms_rp.scene import Obstacle, Scene
from tms_rp.ways import Ways

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
KIND = load("backhoe")
WAYS = Ways(MODEL, KIND)
BACKHOE = Backhoe(MODEL)
NOW: Angles = (0.0, -0.8029, 1.9897, 0.8029)


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> Scene:
    return Scene((Obstacle(PartOf("wall", "site"), Box(min=low, max=high), np.eye(4)),))


def answer(scene: Scene, previous: JointTrajectory | None = None, **angles: float) -> CheckMotion.Response:
    def plan(action: PlanningAction, now: Angles, goal: Any) -> Plan:
        return WAYS.plan(now, action.plan(BACKHOE, now, goal), scene)

    actions = {action.name: action for action in KIND.actions}
    checks = MotionChecks(actions, KIND.joints, lambda: NOW, plan, lambda found: WAYS.nearest(found.made, scene))
    point = JointTrajectoryPoint(positions=list(angles.values()))
    goal = TmsRpZx200ChangePose.Goal(
        trajectory=JointTrajectory(joint_names=[f"{name}_joint" for name in angles], points=[point])
    )
    request = CheckMotion.Request(action="change_pose", goal=pack(goal), previous=previous or JointTrajectory())
    return checks.answer(request, CheckMotion.Response())


def test_a_free_motion_is_told_with_its_path_and_what_it_comes_nearest_to() -> None:
    found = answer(box((5.0, 9.0, 0.0), (9.0, 9.5, 4.0)), swing=0.5)
    assert not found.error_code and list(found.notes) == []
    assert list(found.plan.points[-1].positions)[:4] == pytest.approx([0.5, *NOW[1:]])
    alone = answer(Scene(), swing=0.5)
    assert isinstance(wire.known(alone.nearest), Between) and 0 < alone.clearance < math.inf


@pytest.mark.parametrize("gap", [0.5, 1.0, 2.0])
def test_the_clearance_is_the_gap_between_the_bodies(gap: float) -> None:
    """A wall beside the standing bucket, which is 1.126 m wide and stands 0.087 m to the right of the axis' plane."""
    edge = max(y for _, y, _ in corners("bucket_link"))
    found = answer(box((4.0, edge + gap, 0.0), (12.0, edge + gap + 0.2, 8.0)), swing=0.0)
    near = wire.known(found.nearest)
    expected = min(gap, answer(Scene(), swing=0.0).clearance)
    assert found.clearance == pytest.approx(expected, abs=0.01)
    assert expected < gap or near.find(PartOf) == PartOf("wall", "site")


def corners(link: str) -> list[tuple[float, float, float]]:
    from tms_control.links import Links

    shape = MODEL.shapes[link]
    place = Links(MODEL).places(np.array([(*NOW, 0.0)]))[link][0]
    ends = np.array(np.meshgrid(*zip(shape.min, shape.max, strict=True))).reshape(3, -1)
    return [tuple(map(float, one)) for one in (place[:3, :3] @ ends + place[:3, 3:]).T]  # type: ignore[misc]


def test_a_way_around_is_told() -> None:
    found = answer(box((4.5, 1.5, 0.0), (9.0, 2.5, 2.5)), swing=1.2)
    assert [wire.known(note).find(Around) is not None for note in found.notes] == [True]


def test_it_begins_where_the_plan_before_it_has_ended() -> None:
    first = answer(Scene(), swing=0.5)
    second = answer(Scene(), first.plan, boom=-0.5)
    assert list(second.plan.points[0].positions)[:4] == pytest.approx([0.5, *NOW[1:]])
    assert list(second.plan.points[-1].positions)[:4] == pytest.approx([0.5, -0.5, *NOW[2:]])


def test_limits_and_the_own_body_refuse_lastingly_and_what_stands_there_does_not() -> None:
    limits = answer(Scene(), boom=0.5)
    body = answer(Scene(), swing=0.0, boom=-0.12, arm=2.687, bucket=0.5)
    assert limits.error_code == "OUT_OF_RANGE" and limits.lasting
    assert body.error_code == "COLLISION" and wire.known(body.error_msg).find(Part) is not None and body.lasting
    wall = answer(box((4.0, -1.0, 0.0), (9.0, 1.0, 5.0)), swing=0.1)
    assert wall.error_code == "COLLISION" and not wall.lasting


def test_what_is_no_goal_is_refused() -> None:
    checks = MotionChecks({}, KIND.joints, lambda: NOW, lambda *_: None, lambda _: None)  # type: ignore[arg-type, return-value]
    assert checks.answer(CheckMotion.Request(action="fly"), CheckMotion.Response()).error_code == "NO_SUCH_ACTION"
    broken = CheckMotion.Request(action="change_pose", goal=b"\x00")
    actions = {action.name: action for action in KIND.actions}
    checks = MotionChecks(actions, KIND.joints, lambda: NOW, lambda *_: None, lambda _: None)  # type: ignore[arg-type, return-value]
    assert checks.answer(broken, CheckMotion.Response()).error_code == "GOAL_UNREADABLE"
