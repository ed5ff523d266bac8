"""Primitives of version 6 plan and execute with our planner, in both forms of their goal."""

import math
from types import SimpleNamespace
from typing import Any

import pytest
from geometry_msgs.msg import Point, Pose, Quaternion
from moveit_msgs.msg import Constraints, JointConstraint, OrientationConstraint, RobotTrajectory
from tms_msg_rp.action import TmsRpExcavator
from tms_msg_rp.msg import TmsRpExcavatorJointValues
from tms_msg_rp.srv import TmsRpExcavatorParamGet, TmsRpExcavatorParamSet

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_machine.reasons import Busy, FormContradicted, NotHonoured, PathLeavesConstraint
from tms_reason import wire
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_ros.goals import Outcome
from tms_rp import excavator
from tms_rp.excavator import FAILURE, SUCCESS, ExcavatorServer
from tms_rp.excavator_params import ExcavatorParams
from tms_rp.excavator_settings import Settings
from tms_rp.kind import Angles
from tms_rp.kinds import load
from tms_rp.kinds.backhoe.planner import Backhoe
from tms_rp.node import EXECUTE
from tms_rp.reasons import JointsUnheard, MoveOf, NothingToExecute, OutOfPlane, Succeeded, UnknownCommand
from tms_rp.scene import Scene
from tms_rp.ways import Ways

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
KIND = load("backhoe")
BACKHOE, WAYS = Backhoe(MODEL), Ways(MODEL, KIND)
(PLAN,) = (action for action in KIND.actions if action.name == "plan_pose")
NOW: Angles = (0.0, -0.8029, 1.9897, 0.8029)
LOW: Angles = (0.3, -0.4, 1.5, 0.5)
Goal = TmsRpExcavator.Goal


class Site:
    """A server whose goals are planned in an empty scene; the machine is taken by `reserve`."""

    def __init__(self, settings: Settings | None = None) -> None:
        self.served: list[str] = []
        self.said: list[Any] = []
        self.refusal: Reason | None = None
        site = SimpleNamespace(file=SimpleNamespace(forms=SimpleNamespace(TmsRpExcavator="plan")))
        ros = SimpleNamespace(serve=lambda _type, name, *_: self.served.append(name), offer=lambda *_: None)
        app: Any = SimpleNamespace(machine="zx200", site=site, ros=ros)
        self.server = ExcavatorServer(
            app, PLAN, EXECUTE, lambda action: self.refusal, self._carry_out, lambda: settings or Settings()
        )

    def _carry_out(self, action: Any, goal: Any, request: Any, say: Any) -> Any:
        try:
            plan = WAYS.plan(NOW, action.plan(BACKHOE, NOW, request), Scene())
        except SubtaskFailed as error:
            say(error.reason)
            return Outcome.ABORTED, None
        say(MoveOf(1, 2, 50))
        say(Succeeded())
        return Outcome.SUCCEEDED, plan

    def do(self, request: Any) -> tuple[Outcome, TmsRpExcavator.Result]:
        goal: Any = SimpleNamespace(request=request, publish=self.said.append)
        outcome, result = self.server.run(goal)
        return outcome, result


@pytest.fixture(autouse=True)
def understood(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(excavator, "misfit", lambda *_, servers: None)


def to_joints(*previous: RobotTrajectory, constraints: Constraints | None = None, **angles: float) -> Goal:
    values = TmsRpExcavatorJointValues(joint_names=[f"{name}_joint" for name in angles],
                                       joint_values=list(angles.values()))  # fmt: skip
    return Goal(command=Goal.CMD_PLAN_TO_JOINTS, joint_values=values, previous_pose=list(previous),
                constraints=constraints or Constraints())  # fmt: skip


def end(result: TmsRpExcavator.Result) -> list[float]:
    return list(result.plan.joint_trajectory.points[-1].positions)[:4]


def pose_at(angles: Angles, turned: float = 0.0) -> Pose:
    _, (qx, qy, qz, qw) = BACKHOE.tool((angles[0] + turned, *angles[1:]))
    (px, py, pz), _ = BACKHOE.tool(angles)
    return Pose(position=Point(x=px, y=py, z=pz), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw))


def test_a_plan_to_joint_angles_as_slow_as_the_planner_is_set() -> None:
    outcome, result = Site().do(to_joints(boom=-0.4))
    assert outcome is Outcome.SUCCEEDED and result.success and result.moveit_error_code == SUCCESS
    assert end(result) == pytest.approx([0.0, -0.4, *NOW[2:]])
    _, slow = Site(Settings(max_velocity_scaling_factor=0.1)).do(to_joints(boom=-0.4))
    times = [one.plan.joint_trajectory.points[-1].time_from_start.sec for one in (result, slow)]
    assert times[1] > times[0] + 2


def test_a_plan_goes_on_from_the_one_before() -> None:
    _, first = Site().do(to_joints(swing=0.5))
    _, second = Site().do(to_joints(RobotTrajectory(), first.plan, boom=-0.4))
    begin = second.plan.joint_trajectory.points[0].positions
    assert list(begin)[:4] == pytest.approx(end(first)) and end(second)[0] == pytest.approx(0.5)


def test_a_plan_to_the_pose_that_the_bucket_has_at_some_angles() -> None:
    outcome, result = Site().do(Goal(command=Goal.CMD_PLAN_TO_POSE, pose=pose_at(LOW)))
    assert outcome is Outcome.SUCCEEDED and end(result) == pytest.approx(LOW, abs=1e-6)


def test_an_orientation_beside_the_arm_is_kept_within_its_tolerance() -> None:
    aside = Goal(command=Goal.CMD_PLAN_TO_POSE, pose=pose_at(LOW, turned=0.3))
    outcome, result = Site().do(aside)
    assert outcome is Outcome.ABORTED and isinstance(wire.of(result.message), OutOfPlane)
    outcome, result = Site(Settings(goal_orientation_tolerance=0.5)).do(aside)
    assert outcome is Outcome.SUCCEEDED and end(result)[0] == pytest.approx(LOW[0])


def test_constraints_of_joints_are_kept_and_others_are_refused() -> None:
    site, boom = Site(), JointConstraint(joint_name="boom_joint", position=-0.8, tolerance_above=0.1)
    boom.tolerance_below = 0.1
    outcome, result = site.do(to_joints(boom=-0.4, constraints=Constraints(joint_constraints=[boom])))
    assert (
        outcome is Outcome.ABORTED and result.moveit_error_code == FAILURE and not result.plan.joint_trajectory.points
    )
    assert isinstance(wire.of(result.message), PathLeavesConstraint)
    assert site.do(to_joints(swing=0.4, constraints=Constraints(joint_constraints=[boom])))[0] is Outcome.SUCCEEDED
    level = Constraints(orientation_constraints=[OrientationConstraint()])
    assert site.server.accept(to_joints(boom=-0.4, constraints=level)) == NotHonoured(("orientation_constraints",))


@pytest.mark.parametrize("several", [False, True])
def test_plans_are_executed_as_one_in_both_forms(several: bool) -> None:
    site = Site()
    first, second = (one.plan for one in (site.do(to_joints(swing=0.5))[1], site.do(to_joints(boom=-0.4))[1]))
    request: Any = Goal(command=Goal.CMD_EXECUTE_PLAN, plan=first)
    if several:
        fields = {"command": Goal.CMD_EXECUTE_PLAN, "CMD_EXECUTE_PLAN": Goal.CMD_EXECUTE_PLAN}
        request = SimpleNamespace(**fields, plans=[RobotTrajectory(), first])
    assert site.server.accept(request) is None
    outcome, result = site.do(request)
    assert outcome is Outcome.SUCCEEDED and end(result) == pytest.approx(end(Site().do(to_joints(swing=0.5))[1]))
    assert [one.progress for one in site.said[-2:]] == [0.25, 1.0]
    if several:
        request.plans = [first, second]  # the second one begins elsewhere
        assert site.do(request)[0] is Outcome.ABORTED


def test_goals_that_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    site = Site()
    assert site.served == ["/zx200/tms_rp_excavator"]
    assert site.server.accept(Goal(command=Goal.CMD_EXECUTE_PLAN)) == NothingToExecute()
    assert site.server.accept(Goal(command=7)) == UnknownCommand(7)
    _, made = site.do(to_joints(swing=0.5))
    site.refusal = Busy("zx200:rp")
    assert site.server.accept(Goal(command=Goal.CMD_EXECUTE_PLAN, plan=made.plan)) == site.refusal
    assert site.server.accept(to_joints(swing=0.5)) is None  # it moves nothing
    other = FormContradicted("/peer", "TmsRpExcavator", "plans", "plan", "zx200")
    monkeypatch.setattr(excavator, "misfit", lambda *_, servers: other if not servers else None)
    assert Site().server.accept(to_joints(swing=0.5)) == other


class Params(ExcavatorParams):
    """The services of a zx200."""

    def __init__(self, heard: bool = True) -> None:
        def now() -> Angles:
            if not heard:
                raise SubtaskFailed(JointsUnheard("zx200", "/zx200/joint_states", KIND.joints))
            return NOW

        app: Any = SimpleNamespace(machine="zx200", ros=SimpleNamespace(offer=lambda *_: None, now=stamp))
        super().__init__(app, {name: MODEL.joints[name] for name in KIND.joints}, now, BACKHOE.tool)

    def asked(self, **wanted: bool) -> TmsRpExcavatorParamGet.Response:
        return self.get(TmsRpExcavatorParamGet.Request(**wanted), TmsRpExcavatorParamGet.Response())

    def told(self, **wanted: Any) -> TmsRpExcavatorParamSet.Response:
        leave = dict.fromkeys(("goal_position_tolerance", "goal_orientation_tolerance", "goal_joint_tolerance",
                               "max_velocity_scaling_factor", "max_acceleration_scaling_factor"), -1.0)  # fmt: skip
        request = TmsRpExcavatorParamSet.Request(
            **{**leave, "planning_time": math.nan, "num_planning_attempts": -1, **wanted}
        )
        return self.set(request, TmsRpExcavatorParamSet.Response())


def stamp() -> Any:
    return RobotTrajectory().joint_trajectory.header.stamp


def test_what_the_planner_knows_is_told() -> None:
    found = Params().asked(get_joint_limits=True, get_current_state=True)
    assert found.success and list(found.joint_names) == list(KIND.joints) == list(found.joint_states.name)
    assert (found.min_positions[0], found.max_positions[1]) == (-math.inf, MODEL.joints["boom_joint"].max)
    assert list(found.joint_states.position) == list(NOW)
    assert found.current_ee_pose == pose_at(NOW)
    assert found.planner_id == ""  # not asked for
    assert Params().asked(get_configuration=True).planner_id == "RRTConnectkConfigDefault"
    silent = Params(heard=False).asked(get_current_state=True)
    assert not silent.success and isinstance(wire.of(silent.message), JointsUnheard)


def test_the_planner_is_set_as_their_primitive_does_it() -> None:
    params = Params()
    answer = params.told(goal_position_tolerance=0.5, goal_orientation_tolerance=0.5, max_velocity_scaling_factor=0.8,
                         planner_id="RRTConnectkConfigDefault", planning_pipeline_id="ompl")  # fmt: skip
    assert answer.success and answer.max_velocity_scaling_factor == 0.8 and not answer.allow_replanning
    assert params.settings == Settings(0.5, 0.5, max_velocity_scaling_factor=0.8)


@pytest.mark.parametrize(
    "wrong",
    [{"max_velocity_scaling_factor": 1.5}, {"max_acceleration_scaling_factor": 0.0}, {"planning_time": 0.5},
     {"num_planning_attempts": 10}, {"planner_id": "PTP"}, {"planning_pipeline_id": "chomp"}],
)  # fmt: skip
def test_what_it_cannot_honour_changes_nothing(wrong: dict[str, Any]) -> None:
    params = Params()
    answer = params.told(goal_joint_tolerance=0.3, **wrong)
    assert not answer.success and answer.message and params.settings == Settings()
    assert answer.goal_joint_tolerance == Settings.goal_joint_tolerance
