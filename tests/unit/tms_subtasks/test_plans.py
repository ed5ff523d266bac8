"""Plans and their targets in records, in the form of version 6 of the C++ system."""

from types import SimpleNamespace
from typing import Any

import pytest
from pydantic import ValidationError
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_machine.reasons import BadRecord, NoPlan, PathLeavesConstraint
from tms_machine.stamps import duration, seconds
from tms_reason.errors import SubtaskFailed
from tms_subtasks.change_pose_execute_from_plan import ExecuteFromPlan
from tms_subtasks.change_pose_plan import ChangePosePlan
from tms_subtasks.records.plans import document, stored
from tms_subtasks.records.retiming import retimed
from tms_subtasks.records.waypoints import Waypoint

JOINTS = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel).joints
PLAN = JointTrajectory(
    joint_names=["boom_joint", "arm_joint"],
    points=[
        JointTrajectoryPoint(positions=[-0.5, 1.0], velocities=[0.0, 0.0], accelerations=[0.0, 0.0]),
        JointTrajectoryPoint(
            positions=[-0.25, 2.0], velocities=[0.0, 0.0], accelerations=[0.0, 0.0], time_from_start=duration(2.5)
        ),
    ],
)


def target(kind: str, **data: float) -> dict[str, Any]:
    return {"planning_group": "manipulator", "waypoints": [{"type": kind, "data": data}]}


def test_a_plan_comes_back_as_it_was_stored() -> None:
    kept = document(PLAN)
    last = kept["joint_trajectory"]["points"][1]
    assert last["positions"] == [-0.25, 2.0] and last["time_from_start"] == {"sec": 2, "nanosec": 500000000}
    assert stored({"plan": kept}, "a") == PLAN
    assert stored({}, "a") is None and stored({"plan": {}}, "a") is None


def test_what_is_no_plan_is_told_with_its_record() -> None:
    with pytest.raises(SubtaskFailed) as caught:
        stored({"plan": {"joint_trajectory": {"joint_names": ["boom_joint"], "points": [{"positions": "far"}]}}}, "a")
    assert isinstance(caught.value.reason, BadRecord) and caught.value.reason.record == "a"


def test_targets() -> None:
    now = {"boom_joint": -0.5, "bucket_joint": 1.0}
    absolute = Waypoint.model_validate(target("joint_values_absolute", boom_joint=-0.9))
    assert absolute.goal(PLAN, now.__getitem__) == absolute.joint_angles() == {"boom_joint": -0.9}
    relative = Waypoint.model_validate(target("joint_values_relative", boom_joint=0.125, bucket_joint=0.5))
    assert relative.goal(PLAN, now.__getitem__) == {"boom_joint": -0.125, "bucket_joint": 1.5}
    assert relative.goal(None, now.__getitem__) == {"boom_joint": -0.375, "bucket_joint": 1.5}
    pose = Waypoint.model_validate(target("pose", x=4.0, y=0.0, z=1.0, theta_w=1.5))
    assert pose.goal(None, now.__getitem__) == (4.0, 0.0, 1.0, 1.5)
    assert (pose.velocity_scale, pose.acceleration_scale) == (0.5, 0.5)  # as in the C++ system


@pytest.mark.parametrize(
    "wrong",
    [
        {"waypoints": []},
        {"waypoints": [{"type": "joint_values_absolute", "data": {}}] * 2},
        target("area", x=1.0),
        target("pose", x=1.0),
        target("joint_values_absolute", arm_joint=999.0),  # a search for the furthest angle
        {"velocity_scale": 0.0},
        {"acceleration_scale": 1.01},
        {"constraints": {"joint_constraints": [{"joint_name": "arm_joint"}]}},
        {"constraints": {"position_constraints": [{"weight": 1.0}]}},
    ],
)
def test_what_the_planner_cannot_keep_is_refused(wrong: dict[str, Any]) -> None:
    right = target("joint_values_absolute", boom_joint=-0.9)
    Waypoint.model_validate({**right, "constraints": {"joint_constraints": []}})
    with pytest.raises(ValidationError):
        Waypoint.model_validate({**right, **wrong})


class Planned:
    """A machine that plans and notes what it was asked."""

    def __init__(self) -> None:
        self.asked: list[Any] = []

    model = SimpleNamespace(joints=JOINTS)

    def angle_of(self, joint: str) -> float:
        return -0.5

    def plan_pose(self, _progress: Any, *goal: Any, group: str) -> JointTrajectory:
        self.asked.append((*goal, group))
        return PLAN

    def execute_plans(self, _progress: Any, plans: Any) -> None:
        self.asked.append(plans)


def run(kind: Any, want: Any, record: str, records: dict[str, dict[str, Any]]) -> Planned:
    machine: Any = Planned()
    write = lambda model, name, values, create: records[name].update(values)  # noqa: E731
    kind(machine, want, lambda model, name, age: records[name], write).execute("zx200", record, print)
    planned: Planned = machine
    return planned


def test_a_plan_is_stored_in_its_record_and_goes_on_from_the_one_before() -> None:
    fields = target("joint_values_relative", boom_joint=0.125)
    records: dict[str, dict[str, Any]] = {"A": {"plan": document(PLAN)}, "B": dict(fields)}
    want = Waypoint.model_validate({**fields, "previous_target_record_name": "A", "velocity_scale": 1.0})
    assert run(ChangePosePlan, want, "B", records).asked == [({"boom_joint": -0.125}, PLAN, 1.0, 0.5, "manipulator")]
    assert records["B"]["plan"] == document(PLAN)
    first = Waypoint.model_validate(fields)
    assert run(ChangePosePlan, first, "B", records).asked == [({"boom_joint": -0.375}, None, 0.5, 0.5, "manipulator")]


def test_plans_of_several_records_are_executed_together() -> None:
    records = {"A": {"plan": document(PLAN)}, "B": {}, "C": {"plan": document(PLAN)}}
    assert run(ExecuteFromPlan, SimpleNamespace(retime=False), "A, B,C", records).asked == [[PLAN, PLAN]]
    with pytest.raises(SubtaskFailed) as caught:
        run(ExecuteFromPlan, SimpleNamespace(retime=False), "B", records)
    assert caught.value.reason == NoPlan(("B",))


@pytest.mark.parametrize(("position", "below", "kept"), [(-0.5, 0.1, True), (-0.5, 0.0, True), (0.0, 0.4, False),
                                                         (999.0, 0.0, True), (0.0, 0.6, True)])  # fmt: skip
def test_a_joint_stays_in_the_range_of_its_constraint(position: float, below: float, kept: bool) -> None:
    limit = {"joint_name": "boom_joint", "position": position, "tolerance_above": 0.3, "tolerance_below": below}
    fields = {**target("joint_values_absolute", boom_joint=-0.25), "constraints": {"joint_constraints": [limit]}}
    want, records = Waypoint.model_validate(fields), {"A": dict[str, Any]()}
    if kept:
        run(ChangePosePlan, want, "A", records)
        return
    with pytest.raises(SubtaskFailed) as caught:
        run(ChangePosePlan, want, "A", records)
    assert isinstance(caught.value.reason, PathLeavesConstraint) and records == {"A": {}}


def slow(share: float) -> JointTrajectory:
    """Two joints to and from a speed that is a share of the boom's limit, within 10 s."""
    speed = share * JOINTS["boom_joint"].velocity
    names, zero = ["boom_joint", "arm_joint"], [0.0, 0.0]
    points = [([0.0, 0.0], zero), ([speed * 5, 0.0], [speed, 0.0]), ([speed * 10, 0.0], zero)]
    made = [
        JointTrajectoryPoint(positions=at, velocities=v, accelerations=zero, time_from_start=duration(5.0 * number))
        for number, (at, v) in enumerate(points)
    ]
    return JointTrajectory(joint_names=names, points=made)


def test_retiming_brings_a_plan_to_the_nearest_limit_on_the_same_path() -> None:
    made = retimed(slow(0.25), JOINTS)
    assert [seconds(point.time_from_start) for point in made.points] == pytest.approx([0.0, 1.25, 2.5])
    assert [list(point.positions) for point in made.points] == [list(point.positions) for point in slow(0.25).points]
    assert made.points[1].velocities[0] == pytest.approx(JOINTS["boom_joint"].velocity)
    hard = slow(0.25)
    hard.points[1].accelerations = [0.0, JOINTS["arm_joint"].acceleration]  # at its limit: no faster
    assert retimed(hard, JOINTS).points[1].time_from_start == duration(5.0)
    assert retimed(PLAN, JOINTS) == PLAN  # no velocities
    records = {"A": {"plan": document(slow(0.25))}}
    ((fast,),) = run(ExecuteFromPlan, SimpleNamespace(retime=True), "A", records).asked
    assert seconds(fast.points[2].time_from_start) == pytest.approx(2.5, abs=1e-4)
