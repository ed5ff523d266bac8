"""Their planner is asked for plans only; what it answers is a stored plan like any other, or a reason."""

import threading
from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_rp.action import PlanPose, TmsRpExcavator
from tms_msg_rp.srv import TmsRpExcavatorParamSet
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_machine.reasons import FormContradicted, NoReason
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Foreign, Reason
from tms_ros.goals import Outcome
from tms_rp import their_planner
from tms_rp.kind import Moves
from tms_rp.reasons import MotionCancelled, PlanMisses, PlannerAway, PlannerRefuses
from tms_rp.their_planner import TheirPlanner

JOINTS = ("swing_joint", "boom_joint")
BEFORE = JointTrajectory(joint_names=list(JOINTS), points=[JointTrajectoryPoint(positions=[0.1, -0.5])])


def plan_to(*angles: float) -> JointTrajectory:
    return JointTrajectory(joint_names=list(JOINTS), points=[JointTrajectoryPoint(positions=list(angles))])


def answer(plan: JointTrajectory | None = None, message: str = "", success: bool = True) -> TmsRpExcavator.Result:
    result = TmsRpExcavator.Result(success=success, message=message, moveit_error_code=1 if success else -1)
    if plan is not None:
        result.plan.joint_trajectory = plan
    return result


class Theirs:
    """Their planner: it answers each goal at once, or is away."""

    def __init__(self, *answers: TmsRpExcavator.Result | None, scales: bool = True, cancel: bool = False) -> None:
        self._answers, self._scales, self._cancel = list(answers), scales, cancel
        self.asked: list[TmsRpExcavator.Goal] = []
        self.set: list[TmsRpExcavatorParamSet.Request] = []
        self.cancelled = 0
        self.goal: Any = SimpleNamespace(uuid=b"", cancelled=threading.Event(), on_cancel=None)

    def peer(self, *_: Any) -> "Theirs":
        return self

    def ready(self) -> bool:
        return bool(self._answers)

    def left(self) -> bool:
        return False

    def call(self, _: Any, name: str, request: Any, *__: Any) -> TmsRpExcavatorParamSet.Response:
        assert name == "/zx200/tms_rp_excavator_param_set"
        self.set.append(request)
        return TmsRpExcavatorParamSet.Response(success=self._scales, message="too fast")

    def send(self, goal: TmsRpExcavator.Goal, *, goal_id: Any) -> Any:
        self.asked.append(goal)
        result = self._answers.pop(0)
        if self._cancel:
            self.goal.cancelled.set()
        outcome = None if result is None else Outcome.SUCCEEDED if result.success else Outcome.ABORTED
        return SimpleNamespace(accepted=result is not None, outcome=outcome, result=result, changed=lambda: None,
                               wait_for=lambda holds, _: holds())  # fmt: skip

    def cancel(self, _: Any) -> None:
        self.cancelled += 1

    def way(self, previous: JointTrajectory | None = None, *targets: tuple[float, ...]) -> Moves:
        app: Any = SimpleNamespace(
            machine="zx200", ros=self,
            site=SimpleNamespace(file=SimpleNamespace(forms=SimpleNamespace(TmsRpExcavator="plan"))),
        )  # fmt: skip
        request = PlanPose.Goal(velocity_scale=0.5, acceleration_scale=0.25, planning_group="arm")
        if previous is not None:
            request.previous = previous
        return TheirPlanner(app, JOINTS).way(self.goal, request, Moves(targets or ((0.4, -0.3),), begin=(0.1, -0.5)))


@pytest.fixture(autouse=True)
def understood(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(their_planner, "misfit", lambda *_, servers: None)


def test_it_plans_with_the_scales_and_the_start_of_the_record() -> None:
    theirs = Theirs(answer(plan_to(0.4, -0.3)), answer(plan_to(0.0, -0.3)))
    moves = theirs.way(BEFORE, (0.4, -0.3), (0.0, -0.3))
    assert moves == Moves((), begin=(0.1, -0.5), plans=(plan_to(0.4, -0.3), plan_to(0.0, -0.3)))
    first, second = theirs.asked
    assert first.command == first.CMD_PLAN_TO_JOINTS and first.planning_group == "arm"
    assert dict(zip(first.joint_values.joint_names, first.joint_values.joint_values, strict=True)) == {
        "swing_joint": 0.4, "boom_joint": -0.3,
    }  # fmt: skip
    assert [one.previous_pose[0].joint_trajectory for one in (first, second)] == [BEFORE, plan_to(0.4, -0.3)]
    (told,) = theirs.set
    assert (told.max_velocity_scaling_factor, told.max_acceleration_scaling_factor) == (0.5, 0.25)
    assert told.planning_time < 0 and told.goal_position_tolerance < 0 and told.planner_id == ""  # as they are


def test_without_a_plan_before_it_begins_where_the_arm_is() -> None:
    theirs = Theirs(answer(plan_to(0.4, -0.3)))
    theirs.way()
    assert list(theirs.asked[0].previous_pose) == []


@pytest.mark.parametrize(
    ("theirs", "why"),
    [
        (Theirs(), PlannerAway("zx200", "/zx200/tms_rp_excavator")),
        (Theirs(None), PlannerAway("zx200", "/zx200/tms_rp_excavator")),
        (Theirs(answer(message="no way", success=False)), PlannerRefuses("zx200", Foreign("no way"), -1)),
        (Theirs(answer()), PlannerRefuses("zx200", NoReason(), 1)),  # a success without a plan
        (Theirs(answer(), scales=False), PlannerRefuses("zx200", Foreign("too fast"), 0)),
        (Theirs(answer(plan_to(0.4, -0.2))), PlanMisses("boom_joint", -0.2, -0.3)),
        (Theirs(answer(plan_to(0.4, -0.3)), cancel=True), MotionCancelled()),
    ],
)
def test_why_there_is_no_plan(theirs: Theirs, why: Reason) -> None:
    with pytest.raises(SubtaskFailed) as caught:
        theirs.way()
    assert caught.value.reason == why
    assert all(goal.command != goal.CMD_EXECUTE_PLAN for goal in theirs.asked)


def test_a_goal_without_an_answer_is_cancelled() -> None:
    theirs = Theirs(None)
    with pytest.raises(SubtaskFailed):
        theirs.way()
    assert theirs.cancelled == 1


def test_a_planner_in_another_form_is_asked_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    other = FormContradicted("/peer", "TmsRpExcavator", "plans", "plan", "zx200")
    monkeypatch.setattr(their_planner, "misfit", lambda *_, servers: other if servers else None)
    theirs = Theirs(answer(plan_to(0.4, -0.3)))
    with pytest.raises(SubtaskFailed) as caught:
        theirs.way()
    assert caught.value.reason == other and not theirs.asked and not theirs.set
