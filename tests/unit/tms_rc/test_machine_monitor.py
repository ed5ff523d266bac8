"""What a gateway takes from the machine's messages."""

import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from geometry_msgs.msg import Quaternion
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, JointState

from tms_config.models import MachineModel, Source
from tms_config.yaml_file import parse
from tms_decision.gateway.events import Published, Sampled
from tms_machine.facts import machine_facts
from tms_proof.reasons import ManyPublishers
from tms_proof.standstill import HEADING, JOINTS, PLACE, TURNING, StandStill
from tms_rc import machine_monitor
from tms_ros.topics import Arrival

CONFIGS = Path(__file__).resolve().parents[3] / "configs"
SOURCE = Source(period=0.05, stamps="none", frozen_after=2.0, origin="a test")


def joints(message: Any) -> Any:
    made: Any = machine_monitor.MachineMonitor.__new__(machine_monitor.MachineMonitor)
    made._names = {"swing_joint": "swing_joint", "hook": "boom_joint"}
    return made._joints(message)


def test_joints_are_matched_by_their_names_at_the_border() -> None:
    message = JointState(name=["left_wheel", "hook", "swing_joint"], position=[9.0, 0.5, 0.1], velocity=[9.0, 0.2, 0.0])
    places, speeds = joints(message)
    assert places == {"boom_joint": (0.5,), "swing_joint": (0.1,)}
    assert speeds == {"boom_joint": 0.2, "swing_joint": 0.0}


def test_what_is_not_a_number_was_not_heard() -> None:
    nan = float("nan")
    places, speeds = joints(JointState(name=["swing_joint", "hook"], position=[0.5, nan], velocity=[nan, 0.0]))
    assert places == {"swing_joint": (0.5,)} and speeds == {"boom_joint": 0.0}


def test_joint_states_without_velocities_tell_positions() -> None:
    assert joints(JointState(name=["swing_joint"], position=[0.5])) == ({"swing_joint": (0.5,)}, {})


def odometry(**pose: float) -> Odometry:
    message = Odometry()
    message.pose.pose.position.x = pose.get("x", 0.0)
    message.pose.pose.orientation = Quaternion(z=0.7071067811865476, w=0.7071067811865476)
    message.twist.twist.linear.x, message.twist.twist.angular.z = 0.3, -0.1
    return message


def test_odometry_tells_place_heading_and_speeds() -> None:
    places, speeds = machine_monitor._odometry(odometry(x=2.0))
    assert places[PLACE] == (2.0, 0.0) and abs(places[HEADING][0] - 1.5708) < 1e-4
    assert speeds == {PLACE: 0.3, HEADING: -0.1}


def test_a_place_that_is_not_a_number_was_not_heard() -> None:
    assert machine_monitor._odometry(odometry(x=float("inf")))[0] == {}


def test_the_empty_twist_of_a_global_pose_is_no_speed() -> None:
    assert machine_monitor._pose(odometry())[1] == {}


def test_an_imu_tells_how_it_turns() -> None:
    message = Imu()
    message.angular_velocity.x, message.angular_velocity.z = 0.3, 0.4
    places, speeds = machine_monitor._imu(message)
    assert places == {TURNING: ()} and abs(speeds[TURNING] - 0.5) < 1e-12


class Ros:
    """As much of the node as a view uses, with one source of joint states."""

    def __init__(self) -> None:
        self.waiting: list[Any] = []
        self.voices = ["driver"]
        self.node = self
        self.subscriptions: list[Any] = []

    def sample_arrivals(self, _kind: Any, topic: str, _depth: int) -> Any:
        heard = SimpleNamespace(topic_name=topic, get_publisher_count=lambda: len(self.voices))
        self.subscriptions.append(heard)
        return lambda: [self.waiting.pop(0) for _ in list(self.waiting)]

    def get_publishers_info_by_topic(self, _topic: str) -> list[Any]:
        kind = "sensor_msgs/msg/JointState"
        return [SimpleNamespace(node_namespace="/", node_name=node, topic_type=kind) for node in self.voices]


def test_a_source_that_speaks_again_is_not_believed_before_its_publishers_were_counted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    ros, model = Ros(), parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
    border = next(iter(model.borders.values())).model_copy(update={"sources": {JOINTS: SOURCE}})
    site: Any = SimpleNamespace(border=lambda _: border, model_of=lambda _: model)
    app: Any = SimpleNamespace(machine="m", site=site, ros=ros)
    watch = StandStill(machine_facts("zx200", model, border))
    seen = machine_monitor.MachineMonitor(app, watch)

    def take() -> None:
        for event in seen.samples():
            if isinstance(event, Sampled):
                watch.take(event.source, event.sample)
            elif isinstance(event, Published):
                watch.sources[event.source].publishers = event.nodes

    def speak() -> None:
        message = JointState(name=list(model.initial), position=list(model.initial.values()))
        ros.waiting.append(Arrival(message, now[0], 1))
        take()

    speak()
    assert watch.trouble(now[0]) is None
    now[0] += 5.0
    take()  # the regular count, while the first publisher, killed, is still the only one
    now[0] += 0.01
    ros.voices = ["driver", "driver"]
    speak()
    trouble = watch.trouble(now[0])
    assert trouble is not None and isinstance(trouble.reason, ManyPublishers)
