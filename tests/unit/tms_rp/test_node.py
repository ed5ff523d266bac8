"""Every goal of the planner's process is planned in the whole scene: other machines and records."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import structlog
from geometry_msgs.msg import Point, TransformStamped
from rcl_interfaces.msg import Parameter
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
from tms_msg_db.msg import Record
from tms_msg_db.srv import ListParameters
from tms_msg_rp.action import Excavate, TmsRpZx200ChangePose
from tms_msg_rp.msg import TmsRpZx200PositionWithAngle
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.reasons import PathBlocked
from tms_machine.values import to_parameters
from tms_ros.goals import Outcome
from tms_rp import node
from tms_rp.reasons import Around, Collision, PartOf, Planned, Told
from tms_rp.terrain import Terrain
from tms_rp.trajectory import trajectory
from tms_soil.surface import Heights

RIGHT = (-1.571, -0.3, 1.4, 0.5)
MODELS = {name: parse(CONFIGS / "machines" / f"{name}.yaml", MachineModel) for name in ("zx200", "ic120")}


def frame(child: str, x: float, y: float, yaw: float) -> TransformStamped:
    one = TransformStamped(child_frame_id=child)
    one.header.frame_id = "map"
    one.transform.translation.x, one.transform.translation.y = x, y
    one.transform.rotation.z, one.transform.rotation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return one


class FakeRos:
    """What the planner hears: its joints, /tf with a truck, and the records of the database."""

    def __init__(self, truck: tuple[float, float, float], records: list[Record]) -> None:
        self._frames = [frame("zx200/base_link", 0.0, 0.0, 0.0), frame("ic120_tf/base_link", *truck)]
        self._records = records

    def sample(self, _: Any, topic: str, *__: Any) -> Any:
        heard: dict[str, Any] = {
            "/zx200/joint_states": JointState(name=list(MODELS["zx200"].joints), position=[*RIGHT, 0.0]),
            "/tf": TFMessage(transforms=self._frames),
        }
        return lambda: [heard[topic]] if topic in heard else []

    def poll_in_thread(self, _: float, step: Any, __: str) -> None:
        step()

    def call(self, *_: Any) -> ListParameters.Response:
        return ListParameters.Response(records=self._records)

    def has_service(self, *_: Any) -> bool:
        return True

    def peer(self, *_: Any) -> Any:
        return SimpleNamespace(name="/zx200/rc/follow_joint_trajectory")

    def subscribe(self, *_: Any, **__: Any) -> None:
        pass

    prepare = subscribe


def planner_beside(
    monkeypatch: pytest.MonkeyPatch, truck: tuple[float, float, float], *records: Record
) -> node.Planner:
    """The planner of a zx200 with an ic120 at a place: x [m], y [m], yaw [rad]."""
    monkeypatch.setattr(node, "Permit", lambda *_: None)
    monkeypatch.setattr(node, "watch_server", lambda *_: lambda _: None)
    site = SimpleNamespace(
        file=SimpleNamespace(machines={name: SimpleNamespace(model=name) for name in MODELS}, peers={}, ground=None),
        model_of=MODELS.__getitem__,
        border=lambda name: MODELS[name].borders["sim"].model_copy(
            update={"base_frame": {"zx200": "zx200/base_link", "ic120": "ic120_tf/base_link"}[name]}
        ),
    )  # fmt: skip
    log = structlog.stdlib.get_logger("test")
    app: Any = SimpleNamespace(site=site, machine="zx200", ros=FakeRos(truck, list(records)), pulse=None, log=log)
    return node.Planner(app)


def planned(
    monkeypatch: pytest.MonkeyPatch, swing: float, truck: tuple[float, float, float], *records: Record
) -> tuple[Outcome, Any]:
    """Outcome of a goal that only plans a swing, and what was said of it before `done`."""
    planner = planner_beside(monkeypatch, truck, *records)
    (action,) = (one for one in planner.kind.actions if one.name == "change_pose_plan")
    point = JointTrajectoryPoint(positions=[swing])
    request = TmsRpZx200ChangePose.Goal(trajectory=JointTrajectory(joint_names=["swing_joint"], points=[point]))
    said: list[Any] = []
    goal: Any = SimpleNamespace(id="1")
    outcome, _ = planner._execute(action, goal, request, said.append)
    return outcome, said[-2 if outcome is Outcome.SUCCEEDED else -1]


FAR, AHEAD = (30.0, 0.0, 0.0), (6.0, 1.44, math.pi / 2)


def wall(y: float) -> Record:
    values: list[Parameter] = to_parameters({"x": 7.0, "y": y, "z": 1.0, "dimensions": [3.0, 0.5, 2.0]})
    return Record(record_name="collision_object_wall", type="static", values=values)


def test_nothing_in_the_way(monkeypatch: pytest.MonkeyPatch) -> None:
    outcome, said = planned(monkeypatch, 1.5, FAR)
    assert outcome is Outcome.SUCCEEDED and isinstance(said, Planned)


def test_around_a_truck_and_people_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    outcome, said = planned(monkeypatch, 1.5, AHEAD)
    around = said.find(Around)
    assert outcome is Outcome.SUCCEEDED and around is not None
    assert around.why.find(PartOf).machine == "ic120"


def test_around_what_a_record_tells(monkeypatch: pytest.MonkeyPatch) -> None:
    outcome, said = planned(monkeypatch, 1.5, FAR, wall(0.0))
    assert outcome is Outcome.SUCCEEDED and said.find(Around).why.find(Told) == Told("collision_object_wall")


def test_into_a_truck_it_does_not_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    outcome, said = planned(monkeypatch, 0.0, AHEAD)
    assert outcome is Outcome.ABORTED and said.find(Collision).second.machine == "ic120"


def test_a_truck_that_comes_into_the_way_of_a_motion(monkeypatch: pytest.MonkeyPatch) -> None:
    alone = trajectory(MODELS["zx200"].joints, (*RIGHT, 0.0), [(1.5, *RIGHT[1:], 0.0)])
    assert planner_beside(monkeypatch, FAR)._blocked(alone, 0.0) is None
    blocked = planner_beside(monkeypatch, AHEAD)._blocked(alone, 0.0)
    assert isinstance(blocked, PathBlocked) and blocked.by == PartOf("vessel", "ic120")


def test_a_bucket_that_has_dug_is_kept_level_on_the_next_way(monkeypatch: pytest.MonkeyPatch) -> None:
    planner = planner_beside(monkeypatch, FAR)
    actions = {action.name: action for action in planner.kind.actions}
    point = JointTrajectoryPoint(positions=[1.5, -0.3, 1.7, 1.6])
    swing = TmsRpZx200ChangePose.Goal(
        trajectory=JointTrajectory(joint_names=list(MODELS["zx200"].joints)[:4], points=[point])
    )
    level = (-1.571, -0.5, 2.1, 1.5)
    assert planner.planned(actions["change_pose"], level, swing).moves.through is None
    monkeypatch.setattr(planner._resuming, "move", lambda *_: Outcome.SUCCEEDED)
    place = TmsRpZx200PositionWithAngle(position=Point(x=0.0, y=-6.0, z=0.0), theta_w=1.6)
    for name, held in (("excavate_plan", False), ("excavate", True)):
        goal: Any = SimpleNamespace(id="1", request=Excavate.Goal(position_with_angle=place), publish=lambda _: None)
        assert planner._execute(actions[name], goal, goal.request, lambda _: None)[0] is Outcome.SUCCEEDED
        found = planner.planned(actions["change_pose"], level, swing).moves.through
        assert (found is not None and found.held is not None) == held


def test_a_way_keeps_clear_of_the_ground_as_it_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside a truck that it goes around, the ground is higher than its arm gets."""
    told = Heights(-26.0, -26.0, 0.2, np.zeros((260, 260)))
    x, y = told.centres
    told.z[np.hypot(x, y) > 3.2] = 6.0
    ground = Terrain(told, None, (0.0, 0.0, 0.0))
    monkeypatch.setattr(node, "ToldGround", lambda _: SimpleNamespace(around=lambda: ground))
    outcome, _ = planned(monkeypatch, 1.5, AHEAD)
    assert outcome is Outcome.ABORTED
