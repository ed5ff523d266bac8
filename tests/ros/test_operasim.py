"""The stand-in of OperaSim-PhysX connected to a real bridge: what ROS sees of it, and what reaches its drives."""

import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from com3_msgs.msg import JointCmd
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool

import programs
from conftest import PROJECT, wait_until
from control_client import ControlClient
from tms_config.config import load_site
from tms_machine.places import Places
from tms_ros.node import Ros
from tms_runtime import environment

pytestmark = [
    pytest.mark.ros,
    pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning"),  # a parser that the ROS wheels bring
]
LIMIT = 40.0  # s for whatever must happen at all
MACHINE = "zx200_7"  # a name of its own: other tests may have machines in the same domain
FOUR = ["bucket_joint", "arm_joint", "boom_joint", "swing_joint"]  # the last name shows a wrong layout at once
SITE = """
name: operasimtest
domain: {domain}
backend: physx
ports: {{metrics: {port}}}
services: {{if: {{port: {tcp}, clock: true}}}}
machines: {{{machine}: {{model: zx200}}}}
"""
SCENE = """
machines:
  {machine}: {{model: zx200, place: [-13.85, -9.17, 1.68]}}
  c30r: {{model: c30r, place: [0, 0, 0]}}
"""


class Site:
    """The bridge and the stand-in as processes, a ROS node of somebody else, and the control port of the stand-in."""

    def __init__(self, folder: Path, domain: int, port: int) -> None:
        file, scene = folder / "site.yaml", folder / "scene.yaml"
        file.write_text(SITE.format(domain=domain, port=port, tcp=port + 2, machine=MACHINE))
        scene.write_text(SCENE.format(machine=MACHINE))
        self.bridge_log, self.log = folder / "bridge.log", folder / "operasim.log"
        self.border = load_site(str(file)).border(MACHINE)
        env = {**os.environ, **environment.environment(load_site(str(file)))}
        self.bridge = programs.process("tms:if", env, self.bridge_log)
        words = [
            sys.executable,
            "-m",
            "operasim",
            "--scene",
            str(scene),
            "--port",
            str(port + 2),
            "--control-port",
            "0",
        ]
        with self.log.open("w") as out:
            self.simulator = subprocess.Popen(words, cwd=PROJECT / "tests", stdout=out, stderr=out)
        self.ros = Ros("operasim_test")
        self.until(lambda: "event=control" in self.log.read_text(), "the control port")
        (control,) = re.findall(r"event=control port=(\d+)", self.log.read_text())
        self._control = ControlClient(int(control), LIMIT)
        self.command = self._control.command

    def until(self, holds: Callable[[], Any], what: str) -> None:
        wait_until(
            lambda: bool(holds()), LIMIT, lambda: f"{what}\n{self.log.read_text()}\n{self.bridge_log.read_text()}"
        )

    def truth(self) -> dict[str, Any]:
        found = self.command("state")["machines"][MACHINE]
        assert isinstance(found, dict)
        return found

    def joint(self, name: str) -> dict[str, float]:
        found = self.truth()["joints"][name]
        assert isinstance(found, dict)
        return found

    def hear(self, kind: Any, topic: str) -> list[Any]:
        found: list[Any] = []
        self.ros.subscribe(kind, f"/{MACHINE}/{topic}", found.append, depth=10)
        return found

    def speaker(self, kind: Any, topic: str) -> Any:
        publisher = self.ros.publisher(kind, f"/{MACHINE}/{topic}")
        self.until(lambda: publisher.get_subscription_count() > 0, f"the bridge hears {topic}")
        return publisher

    def close(self) -> None:
        self._control.close()
        for process in (self.simulator, self.bridge):
            process.terminate()
        try:
            assert self.simulator.wait(10) == 0, self.log.read_text()
            assert self.bridge.wait(10) == 0, self.bridge_log.read_text()
        finally:
            self.simulator.kill()
            self.bridge.kill()
            self.ros.close()


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, domain: int, first_port: int) -> Iterator[Site]:
    folder = tmp_path_factory.mktemp("operasim")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(domain))
        patch.setenv("TMS_STATE", str(folder / "state"))
        made = Site(folder, domain, first_port + 64)
        yield made
        made.close()


def stamp(message: Any) -> float:
    return float(message.header.stamp.sec + message.header.stamp.nanosec * 1e-9)


def test_what_it_tells_arrives(site: Site) -> None:
    states, places, odometry = (
        site.hear(JointState, "joint_state"), site.hear(PoseStamped, "base_link/pose"), site.hear(Odometry, "odom"),
    )  # fmt: skip
    site.until(lambda: len(states) > 5 and places and odometry, "joint states, pose and odometry")
    assert list(states[-1].name) == ["swing_joint", "boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint"]
    assert stamp(states[-1]) - stamp(states[-2]) == pytest.approx(0.04)
    told = places[-1].pose.position  # without z: it falls to the ground at first
    assert [told.x, told.y] == pytest.approx(site.truth()["place"][:2], abs=1e-5)
    assert odometry[-1].child_frame_id == f"{MACHINE}/base_link"
    assert "endpoint_says" in site.log.read_text()  # c30r is no machine of the site


def test_its_place_is_known_without_frames(site: Site) -> None:
    places = Places(site.ros, {MACHINE: site.border})
    site.until(lambda: places.take() == {MACHINE}, "its place")
    place, true = places.place(MACHINE), site.truth()
    assert place is not None
    assert place[:3] == pytest.approx((*true["place"][:2], true["yaw"]), abs=1e-5)


def test_front_cmd_moves_the_arm(site: Site) -> None:
    states = site.hear(JointState, "joint_state")
    front = site.speaker(JointCmd, "front_cmd")
    wanted = [0.3, 1.8, -0.9, 0.2]

    def there() -> bool:
        front.publish(JointCmd(joint_name=FOUR, control_type=0, position=wanted))
        told = dict(zip(states[-1].name, states[-1].position, strict=True)) if states else {}
        return bool(told) and all(abs(told[name] - one) < 0.01 for name, one in zip(FOUR, wanted, strict=True))

    site.until(there, "the arm is where it should be")
    assert [site.joint(name)["target"] for name in FOUR] == wanted


def test_tracks_and_stop(site: Site) -> None:
    drive, stop = site.speaker(Twist, "tracks/cmd_vel"), site.speaker(Bool, "emg_stop")
    twist = Twist()
    twist.linear.x = 0.5

    def moving() -> bool:
        drive.publish(twist)
        return bool(site.truth()["tracks"]["left"] > 0.2)

    site.until(moving, "it drives")

    def stopped() -> bool:
        stop.publish(Bool(data=True))
        return bool(site.truth()["stopped"])

    site.until(stopped, "it is stopped")
    site.until(lambda: site.truth()["tracks"] == {"left": 0.0, "right": 0.0}, "it stands")
    stop.publish(Bool(data=False))
    site.until(lambda: not site.truth()["stopped"], "it is released")


def test_a_lost_connection_comes_back(site: Site) -> None:
    states = site.hear(JointState, "joint_state")
    connections = site.log.read_text().count("event=handshake")
    site.until(lambda: states, "joint states")
    site.command("cut 0.2")
    site.until(lambda: site.log.read_text().count("event=handshake") > connections, "a new connection")
    again = site.command("state")["time"]
    site.until(lambda: stamp(states[-1]) > again, "joint states of now")
    assert [stamp(one) for one in states] == sorted(stamp(one) for one in states)


def test_after_a_restart_its_time_begins_anew(site: Site) -> None:
    states = site.hear(JointState, "joint_state")
    site.until(lambda: states and stamp(states[-1]) > 1.5, "some time")
    site.command("restart 0.2")
    site.until(lambda: stamp(states[-1]) < 1.5, "joint states of the new start")
    assert states[-1].position[0] == 0.0
