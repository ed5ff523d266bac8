"""A rehearsed subtask asks its planner what it would do: goals of the arm one after another, and nothing moves."""

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from tms_msg_rp.action import Excavate, PlanPose, TmsRpZx200ChangePose
from tms_msg_rp.srv import CheckMotion
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_kit.rehearsal import NotOfArm, Refused, Rehearsal
from tms_machine.reasons import Busy
from tms_reason.wire import to_line
from tms_ros.packing import unpack

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
RECORDS: dict[str, Mapping[str, Any]] = {
    "dig": {"position_with_angle": 1.0, "x": 6.0, "y": 1.0, "z": 0.0, "theta_w": 1.5},
    "pose": {"trajectory": 1.0, "swing_joint": 0.3, "boom_joint": -0.5, "arm_joint": 1.5, "bucket_joint": 0.5,
             "bucket_end_joint": 0.0},
    "place": {"x": 1.0, "y": 2.0, "qx": 0.0, "qy": 0.0, "qz": 0.0, "qw": 1.0},
    "turn": {"planning_group": "arm", "waypoints": [{"type": "joint_values_relative", "data": {"swing_joint": 0.5}}]},
}  # fmt: skip


def plan(swing: float) -> JointTrajectory:
    points = [JointTrajectoryPoint(positions=[angle, -0.5, 1.5, 0.5, 0.0]) for angle in (0.0, swing)]
    return JointTrajectory(joint_names=list(MODEL.joints), points=points)


class Planner:
    """Answers with a plan that ends at a swing of 0.7 rad."""

    def __init__(self, refuses: str = "") -> None:
        self.asked: list[CheckMotion.Request] = []
        self._refuses = refuses
        self.rehearsal = Rehearsal(SimpleNamespace(), "zx200_1", "zx200", MODEL, self._answer)  # type: ignore[arg-type]

    def _answer(self, request: CheckMotion.Request) -> CheckMotion.Response:
        self.asked.append(request)
        if request.action == self._refuses:
            return CheckMotion.Response(error_code="BUSY", error_msg=to_line(Busy("x")), lasting=True)
        return CheckMotion.Response(plan=plan(0.7))

    def rehearse(self, subtask: str, record: str) -> None:
        self.rehearsal.rehearse(subtask, record, {}, lambda machine, name: RECORDS[name])


def test_the_goal_is_what_the_subtask_would_send() -> None:
    planner = Planner()
    planner.rehearse("subtask_zx200_excavate_simple", "dig")
    (asked,) = planner.asked
    goal = unpack(bytes(asked.goal), Excavate.Goal)
    assert asked.action == "excavate" and goal.position_with_angle.position.x == 6.0
    assert list(asked.previous.points) == []


def test_a_motion_begins_where_the_last_one_has_ended_and_a_plan_alone_moves_nothing() -> None:
    planner = Planner()
    for subtask in ("subtask_zx200_change_pose_plan", "subtask_zx200_change_pose", "subtask_zx200_change_pose"):
        planner.rehearse(subtask, "pose")
    assert [asked.action for asked in planner.asked] == ["change_pose_plan", "change_pose", "change_pose"]
    assert [len(asked.previous.points) for asked in planner.asked] == [0, 0, 2]
    goal = unpack(bytes(planner.asked[0].goal), TmsRpZx200ChangePose.Goal)
    assert goal.trajectory.points[0].positions[0] == 0.3


def test_stored_plans_and_relative_angles_are_those_of_the_rehearsal() -> None:
    planner = Planner()
    planner.rehearse("subtask_zx200_change_pose", "pose")
    planner.rehearse("primitive_excavator_change_pose_plan", "turn")
    wanted = unpack(bytes(planner.asked[1].goal), PlanPose.Goal)
    assert list(wanted.trajectory.points[0].positions) == pytest.approx([0.7 + 0.5])
    planner.rehearse("primitive_excavator_change_pose_execute_from_plan", "turn")
    assert planner.asked[2].action == "execute_plans"
    assert "plan" not in RECORDS["turn"]


def test_a_refusal_leaves_the_arm_where_it_was() -> None:
    planner = Planner(refuses="excavate")
    with pytest.raises(Refused) as caught:
        planner.rehearse("subtask_zx200_excavate_simple", "dig")
    assert caught.value.reason == Busy("x") and caught.value.lasting
    planner.rehearse("subtask_zx200_change_pose", "pose")
    assert list(planner.asked[-1].previous.points) == []


def test_what_does_not_move_the_arm_asks_nobody() -> None:
    planner = Planner()
    planner.rehearsal._ros = SimpleNamespace(now=Time)  # type: ignore[assignment]
    with pytest.raises(NotOfArm):
        planner.rehearse("st_zx200_navigate_anywhere", "place")
    assert planner.asked == []
