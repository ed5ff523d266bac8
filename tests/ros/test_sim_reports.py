"""What a stand-in says as a real process, beside its true motion: sources of the border, and the faults that lie."""

import json
import math
import os
import time
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

import pytest
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, String

import programs
from conftest import wait_until
from stand_in_rig import client_in
from tms_config.config import load_site
from tms_ros.node import Ros
from tms_runtime import environment

pytestmark = [
    pytest.mark.ros,
    pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning"),  # a parser that the ROS wheels bring
]
NAME = "zx120_6"  # a name of its own: other tests may have machines in the same domain
SITE = """
name: reports
domain: {domain}
ports: {{metrics: {port}}}
sim: {{names: physx}}
services: {{}}
machines: {{{name}: {{model: zx120}}}}
"""
JOINTS = ["swing_joint", "boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint"]
LIMIT = 40.0  # s for whatever must happen at all


class Said:
    """What is heard of the machine, newest last, and when."""

    def __init__(self, ros: Ros) -> None:
        self.ros = ros
        self.received: dict[str, list[Any]] = {"joint_states": [], "odom": [], "pose": [], "truth": []}
        for kind, key, topic in (
            (JointState, "joint_states", "joint_states"), (Odometry, "odom", "odom"),
            (PoseStamped, "pose", "base_link/pose"), (JointState, "truth", "sim/truth"),
        ):  # fmt: skip
            ros.subscribe(kind, f"/{NAME}/{topic}", self.received[key].append, depth=20)
        self._fault = ros.publisher(String, f"/{NAME}/sim/fault")
        self._drive = ros.publisher(Twist, f"/{NAME}/tracks/cmd_vel")
        self._swing = ros.publisher(Float64, f"/{NAME}/swing/cmd")

    def until(self, there: Callable[[], bool], what: str) -> None:
        wait_until(there, LIMIT, what)

    def more(self, key: str, count: int = 10) -> list[Any]:
        """Messages from now on."""
        begun = len(self.received[key])
        self.until(lambda: len(self.received[key]) >= begun + count, f"{count} more of {key}")
        return self.received[key][begun:]

    def be(self, **fault: object) -> None:
        self._fault.publish(String(data=json.dumps(fault)))

    def drive(self, v: float) -> None:
        twist = Twist()
        twist.linear.x = v
        self._drive.publish(twist)
        here = self.received["truth"][-1].position[0] if self.received["truth"] else 0.0
        self._swing.publish(Float64(data=here + 10.0 * v))

    def true(self, key: str) -> float:
        return float(self.received["truth"][-1].velocity[[*JOINTS, "x", "y", "yaw"].index(key)])

    def moving(self) -> None:
        def moves() -> bool:
            self.drive(0.3)
            return bool(self.received["truth"]) and self.true("x") > 0.2 and self.true("swing_joint") > 0.2

        self.until(moves, "true motion")


@pytest.fixture(scope="module")
def stand_in(tmp_path_factory: pytest.TempPathFactory, domain: int, first_port: int) -> Iterator[Said]:
    folder = tmp_path_factory.mktemp("reports")
    with client_in(folder, domain, first_port) as ros:
        file = folder / "reports.yaml"
        file.write_text(SITE.format(domain=domain, port=first_port + 76, name=NAME))
        said = Said(ros)
        env = {**os.environ, **environment.environment(load_site(str(file)))}
        process = programs.process(f"sim:{NAME}", env, folder / "log.txt")
        try:
            said.until(lambda: all(said.received.values()), "telemetry")
            yield said
        finally:
            process.terminate()
            process.wait(30)


@pytest.fixture
def said(stand_in: Said) -> Said:
    """The machine in order, and moving: joint and tracks."""

    def in_order() -> bool:
        stand_in.be()
        state = stand_in.more("joint_states", 2)[-1]
        truth = stand_in.received["truth"][-1]
        return len(state.name) == len(JOINTS) and state.position[0] == pytest.approx(truth.position[0], abs=0.1)

    stand_in.until(in_order, "order")
    stand_in.moving()
    return stand_in


def stamps(messages: list[Any]) -> list[float]:
    return [message.header.stamp.sec + message.header.stamp.nanosec * 1e-9 for message in messages]


def test_sources_as_the_border_declares_them(said: Said) -> None:
    pose = said.more("pose", 25)
    assert {message.header.frame_id for message in pose} == {"map"}
    gaps = [b - a for a, b in pairwise(stamps(pose))]
    assert sum(gaps) / len(gaps) == pytest.approx(0.06, rel=0.2)  # as the border says, though its timer has 0.04 s
    assert 0.0 < stamps(pose)[0] < 3600.0  # since it started, not Unix time
    assert abs(stamps(said.more("truth"))[-1] - time.time()) < 5.0
    assert said.received["joint_states"][-1].name == JOINTS
    truth = said.received["truth"][-1]
    assert truth.name == [*JOINTS, "x", "y", "yaw"]
    assert pose[-1].pose.position.x == pytest.approx(truth.position[5], abs=0.5)


def test_the_truth_is_told_with_every_step(said: Said) -> None:
    """25 a second; between two steps the machine does not move."""
    seen = stamps(said.more("truth", 100))
    assert len(seen) / (seen[-1] - seen[0]) > 20.0  # on a busy machine


def fault_seen(said: Said, key: str, shown: Callable[[list[Any]], bool], **fault: object) -> None:
    """A fault shows in what is told, while the machine truly moves."""

    def seen() -> bool:
        said.be(**fault)
        said.moving()
        return shown(said.more(key, 12)[2:])

    said.until(seen, f"{fault} in {key}")
    assert said.true("x") > 0.2


def test_zero_velocity(said: Said) -> None:
    fault_seen(said, "joint_states", lambda m: not any(m[-1].velocity) and m[-1].position != m[0].position,
               zero_velocity=True)  # fmt: skip
    fault_seen(said, "odom", lambda m: m[-1].twist.twist.linear.x == 0.0, zero_velocity=True)


@pytest.mark.parametrize("key", ["joint_states", "odom", "pose"])
def test_frozen_stamp(said: Said, key: str) -> None:
    fault_seen(said, key, lambda m: all(one == m[0] for one in m), frozen_stamp=True)


def test_replay(said: Said) -> None:
    def loops(messages: list[Any]) -> bool:
        places = [message.pose.pose.position.x for message in messages]
        return min(b - a for a, b in pairwise(places)) < -0.1

    def seen() -> bool:
        said.be(replay=True)
        messages = said.more("odom", 60)
        assert stamps(messages) == sorted(stamps(messages))
        return loops(messages)

    said.until(seen, "a jump back to where the loop began")


def test_mute(said: Said) -> None:
    left = [name for name in JOINTS if name != "arm_joint"]
    fault_seen(said, "joint_states", lambda m: all(list(one.name) == left and len(one.position) == 4 for one in m),
               mute=["arm_joint"])  # fmt: skip


def test_jump(said: Said) -> None:
    def displaced(messages: list[Any]) -> bool:
        return bool(messages[-1].pose.position.x - said.received["truth"][-1].position[5] > 3.0)

    fault_seen(said, "pose", displaced, jump=5.0)


def test_nan(said: Said) -> None:
    fault_seen(said, "joint_states", lambda m: all(map(math.isnan, [*m[-1].position, *m[-1].velocity])), nan=True)
    fault_seen(said, "odom", lambda m: math.isnan(m[-1].pose.pose.position.x), nan=True)
    assert not math.isnan(said.received["truth"][-1].position[5])


def test_back_in_time(said: Said) -> None:
    before = stamps(said.more("joint_states"))[-1]
    fault_seen(said, "joint_states", lambda m: stamps(m)[-1] < before, back_in_time=1000.0)


def test_a_second_publisher_says_that_it_stands(said: Said) -> None:
    def publishers() -> int:
        return int(said.ros.node.count_publishers(f"/{NAME}/odom"))

    assert publishers() == 1

    def stands_and_moves(messages: list[Any]) -> bool:
        speeds = {message.twist.twist.linear.x for message in messages}
        return 0.0 in speeds and max(speeds) > 0.2

    fault_seen(said, "odom", stands_and_moves, second_publisher=True)
    fault_seen(said, "joint_states", lambda m: {any(one.velocity) for one in m} == {True, False}, second_publisher=True)
    assert publishers() == 2
    said.be()
    said.until(lambda: publishers() == 1, "a lonely publisher")


def test_creep_is_told_and_true(said: Said) -> None:
    said.drive(0.0)
    said.until(lambda: not any(said.received["truth"][-1].velocity), "stand-still")
    said.be(creep=0.05)
    said.until(lambda: said.true("x") == pytest.approx(0.05), "true creeping")
    said.until(lambda: said.received["odom"][-1].twist.twist.linear.x == pytest.approx(0.05), "creeping that is told")
    said.be()
    said.until(lambda: said.true("x") == 0.0, "its end")
