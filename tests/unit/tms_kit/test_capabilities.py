"""What a machine's answers mean to a subtask: success only when it says so in every way it can."""

from types import SimpleNamespace
from typing import Any

import pytest
from com3_msgs.action import SetDumpAngle
from geometry_msgs.msg import Point, Pose, PoseStamped
from nav2_msgs.action import ComputePathToPose, FollowWaypoints, NavigateThroughPoses, NavigateToPose
from nav_msgs.msg import Path
from pydantic import ValidationError
from tms_msg_rp.action import (
    Excavate,
    ExecutePlans,
    PlanPose,
    Release,
    TmsRpBulldozerBlade,
    TmsRpZx200ChangePose,
)
from tms_msg_ur.action import NextStepPermission
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_kit.acting import missed
from tms_kit.machine import Machine
from tms_machine.reasons import Aborted, DrivingThrough, DrivingTo, NoReason, PersonSaysNo, Rejected
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_ros.client import Call
from tms_ros.goals import Outcome
from tms_subtasks.excavate_simple import DigPoint, excavate_simple
from tms_subtasks.release_simple import Opening
from tms_subtasks.sample_joint import Angle

PATH = [Pose(position=Point(x=float(x))) for x in range(3)]


class Recorded(Machine):
    """A machine that answers every goal with `result` after `heard` was given `feedback`."""

    def __init__(self, model: str, result: Any = None, feedback: Any = None) -> None:
        ros: Any = SimpleNamespace(now=lambda: PATH_TIME)
        super().__init__(ros, f"{model}_1", model, parse(CONFIGS / "machines" / f"{model}.yaml", MachineModel), 60.0)
        self.sent: list[tuple[Any, str, Any]] = []
        self._result, self._feedback = result, feedback

    def act(self, action_type: Any, action: str, goal: Any, received: Any = None) -> Any:
        self.sent.append((action_type, action, goal))
        if self._feedback is not None:
            received(self._feedback)
        return self._result


PATH_TIME = NavigateToPose.Goal().pose.header.stamp


def waypoints(*numbers: int) -> Any:
    """A result as Jazzy's Nav2 gives it, and as Humble's does."""
    return SimpleNamespace(missed_waypoints=[SimpleNamespace(index=number) for number in numbers])


def test_missed_waypoints_of_both_distributions() -> None:
    assert missed(waypoints(1, 2)) == missed(SimpleNamespace(missed_waypoints=[1, 2])) == [1, 2]
    assert missed(FollowWaypoints.Result()) == missed(None) == []


def test_a_path_with_missed_waypoints_is_a_failure_that_names_them() -> None:
    Recorded("ic120", waypoints()).follow(print, PATH)
    with pytest.raises(SubtaskFailed, match=r"MISSED_WAYPOINTS: .* 1 \(1.00 m, 0.00 m\); 2 \(2.00 m, 0.00 m\)"):
        Recorded("ic120", waypoints(1, 2)).follow(print, PATH)


def test_an_angle_that_was_not_reached_is_a_failure() -> None:
    Recorded("ic120", SetDumpAngle.Result(success=True)).set_dump_angle(print, -1.0)
    with pytest.raises(SubtaskFailed, match="NOT_REACHED"):
        Recorded("ic120", SetDumpAngle.Result(success=False)).set_dump_angle(print, -1.0)


def test_what_the_model_lacks_is_refused() -> None:
    machine = Recorded("ic120")
    with pytest.raises(SubtaskFailed, match="NO_CAPABILITY: ic120_1 has no set_swing_angle"):
        machine.set_swing_angle(print, 1.0)
    assert machine.sent == []


@pytest.mark.parametrize("angle", [400.0, -361.0])
def test_a_sample_of_more_than_a_turn_is_no_pose_to_stay_in(angle: float) -> None:
    given = {"joint": "swing_joint", "field": "goal", "goal": angle}
    with pytest.raises(ValidationError, match="more than one turn"):
        Angle.model_validate(given)
    assert Angle.model_validate({**given, "goal": 360.0}).angle == 360.0


@pytest.mark.parametrize(("outcome", "stopped"), [(Outcome.CANCELED, True), (Outcome.LOST, False)])
def test_a_motion_whose_server_was_lost_as_it_was_stopped_was_not_seen_to_end(outcome: Outcome, stopped: bool) -> None:
    machine, call = Recorded("zx200"), Call(bytes(16), None, None)
    call.accepted = True
    peer: Any = SimpleNamespace(cancel=lambda one: one.end(outcome))
    machine._calls = [(peer, call)]
    assert machine.release() is stopped


def test_goals_go_through_the_gateway_in_the_map() -> None:
    machine = Recorded("d37pxi")
    machine.navigate_to(print, PATH[1])
    machine.navigate_through(print, PATH)
    assert [action for _, action, _ in machine.sent] == ["rc/navigate_to_pose", "rc/navigate_through_poses"]
    assert machine.sent[0][2].pose.header.frame_id == machine.sent[1][2].poses[2].header.frame_id == "map"


def test_feedback_is_passed_on() -> None:
    said: list[Reason | str] = []
    feedback = NavigateThroughPoses.Feedback(distance_remaining=3.25, number_of_poses_remaining=2)
    Recorded("ic120", feedback=feedback).navigate_through(said.append, PATH)
    done = waypoints()
    Recorded("ic120", done, FollowWaypoints.Feedback(current_waypoint=1)).follow(said.append, PATH)
    assert said == [DrivingThrough(3.25, 2), DrivingTo(1, 2)]


def test_plan_variants_ask_the_servers_that_never_move() -> None:
    machine = Recorded("zx120")
    machine.change_pose(print, joints={"boom_joint": -0.5}, plan_only=True)
    machine.excavate(print, (4.0, 0.0, 0.0), 1.0, 0.0, plan_only=True)
    machine.change_pose(print, joints={"boom_joint": -0.5})
    assert [(kind, action) for kind, action, _ in machine.sent] == [
        (TmsRpZx200ChangePose, "tms_rp_zx120_change_pose_plan"),
        (Excavate, "tms_rp_zx120_excavate_plan"),
        (TmsRpZx200ChangePose, "tms_rp_zx120_change_pose"),
    ]


def test_a_dig_has_the_figures_of_its_record_and_the_usual_ones_else() -> None:
    machine = Recorded("zx200")
    record = {"position_with_angle": 1.0, "x": 6.0, "y": 1.0, "z": 0.0, "theta_w": 1.5}
    for more in ({}, {"depth": 0.4, "drag": 2.0}):
        excavate_simple(machine, DigPoint.model_validate({**record, **more}), print)
    usual, given = (goal for _, _, goal in machine.sent)
    assert (usual.depth, usual.drag, usual.lift) == (1.0, 1.0, 0.5)
    assert (given.depth, given.drag, given.lift) == (0.4, 2.0, 0.5)
    for wrong in ({"depth": 0.0}, {"drag": -1.0}, {"lift": float("nan")}):
        with pytest.raises(ValidationError):
            DigPoint.model_validate({**record, **wrong})


def test_a_bucket_is_emptied_where_it_is_or_over_the_place_of_the_record() -> None:
    machine, place = Recorded("zx200"), {"x": 5.0, "y": 2.0, "z": 3.5, "theta_w": 3.0}
    for more in ({}, place, {**place, "position_with_angle": 1.0}):
        want = Opening.model_validate({"target_angle": -0.3, **more})
        machine.release_soil(print, want.target_angle, want.place())
    assert [(kind, len(goal.position_with_angle)) for kind, _, goal in machine.sent] == [
        (Release, 0), (Release, 0), (Release, 1),
    ]  # fmt: skip
    assert machine.sent[2][2].position_with_angle[0].theta_w == 3.0
    with pytest.raises(ValidationError):
        Opening.model_validate({"target_angle": -0.3, "position_with_angle": 1.0, "x": 5.0})


def test_a_plan_comes_from_the_planner_and_goes_back_to_it() -> None:
    plan = JointTrajectory(joint_names=["boom_joint"], points=[JointTrajectoryPoint(positions=[-0.5])])
    machine = Recorded("zx200", PlanPose.Result(plan=plan))
    assert machine.plan_pose(print, {"boom_joint": -0.5}, None, 0.5, 0.25) == plan
    machine.plan_pose(print, (4.0, 0.0, 1.0, 1.5), plan, 1.0, 1.0)
    machine.execute_plans(print, [plan, plan])
    (_, planned, first), (_, _, second), (kind, executed, goal) = machine.sent
    assert (planned, executed) == ("tms_rp_zx200_plan_pose", "tms_rp_zx200_execute_plans")
    assert (first.velocity_scale, first.acceleration_scale, list(first.previous.points)) == (0.5, 0.25, [])
    assert list(first.trajectory.points[0].positions) == [-0.5]
    assert second.previous == plan and second.position_with_angle_sequence[0].theta_w == 1.5
    assert kind is ExecutePlans and list(goal.plans) == [plan, plan]


def test_a_blade_that_says_that_it_is_not_there_is_a_failure() -> None:
    angles = {"lift_joint": -0.3, "tilt_joint": 0.0}
    machine = Recorded("d37pxi", TmsRpBulldozerBlade.Result(success=True), TmsRpBulldozerBlade.Feedback())
    machine.set_blade(print, angles, hold=True)
    ((_, action, goal),) = machine.sent
    assert action == "rc/set_bulldozer_blade" and goal.blade_hold
    assert (list(goal.joint_name), list(goal.goal_position)) == (["lift_joint", "tilt_joint"], [-0.3, 0.0])
    with pytest.raises(SubtaskFailed, match="BLADE_NOT_THERE"):
        Recorded("d37pxi", TmsRpBulldozerBlade.Result(success=False)).set_blade(print, angles, hold=False)


def test_a_path_comes_from_the_navigation_and_goes_through_the_gateway() -> None:
    found = Path(poses=[PoseStamped(pose=pose) for pose in PATH])
    machine = Recorded("mst110cr", ComputePathToPose.Result(path=found))
    assert machine.compute_path(print, PATH[2]) == PATH
    machine.follow_path(print, PATH)
    assert [action for _, action, _ in machine.sent] == ["compute_path_to_pose", "rc/follow_path"]
    assert [one.header.frame_id for one in machine.sent[1][2].path.poses] == ["map"] * 3
    with pytest.raises(SubtaskFailed, match="PATH_EMPTY"):
        Recorded("mst110cr", ComputePathToPose.Result()).compute_path(print, PATH[2])
    with pytest.raises(SubtaskFailed, match="NO_CAPABILITY"):
        Recorded("d37pxi").compute_path(print, PATH[2])


def test_a_person_is_asked_for_the_machine_by_the_name_of_the_record() -> None:
    machine = Recorded("ic120")
    machine.ask_person(print, "next_step")
    goal = NextStepPermission.Goal(machinename="ic120_1,next_step")
    assert machine.sent == [(NextStepPermission, "request_wait_ur", goal)]


@pytest.mark.parametrize(
    ("end", "told"),
    [(Aborted(NoReason(), "/x"), PersonSaysNo("next_step")), (Rejected(NoReason(), "/x"), Rejected(NoReason(), "/x"))],
)
def test_a_no_is_told_as_one(end: Reason, told: Reason) -> None:
    class Answered(Recorded):
        def act(self, *_: Any, **__: Any) -> Any:
            raise SubtaskFailed(end)

    with pytest.raises(SubtaskFailed) as failed:
        Answered("ic120").ask_person(print, "next_step")
    assert failed.value.reason == told
