"""Processes of one stand-in machine, and a client that watches it and sends it goals."""

import json
import math
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from com3_msgs.action import SetDumpAngle
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
from nav_msgs.msg import Path as Way
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

import programs
from conftest import wait_until
from tms_config.config import load_site
from tms_machine.border import PLAN
from tms_ros.client import Call
from tms_ros.goals import Outcome
from tms_ros.node import Ros
from tms_runtime import environment

LIMIT = 40.0  # s for whatever must happen at all
SITE = """
name: simtest
domain: {domain}
ports: {{metrics: {port}}}
sim: {{speed: 10.0, seed: 1, names: {names}}}
services: {{}}
machines: {{{machine}: {{model: {model}, start: [10.0, 5.0, 1.5708]}}}}
"""


class Rig:
    """One stand-in and a client."""

    def __init__(self, ros: Ros, folder: Path, machine: str, site: str, processes: Sequence[str] = ("sim:{}",)) -> None:
        file, self._log = folder / f"{machine}.yaml", folder / f"{machine}.log"
        file.write_text(site)
        self.ros, self.machine, self.border = ros, machine, load_site(str(file)).border(machine)
        self.states: list[Any] = []
        self.odom: list[Any] = []
        self.frames: dict[str, Any] = {}
        self.said: list[Any] = []
        self.plans: list[Any] = []
        self._subscriptions = [  # before the machine is there: what is told once would be missed by one that comes late
            ros.subscribe(Way, f"/{machine}/{PLAN}", self.plans.append, depth=10),
            ros.subscribe(JointState, f"/{machine}/{self.border.joint_states}", self.states.append, depth=10),
            ros.subscribe(Odometry, f"/{machine}/{self.border.odom}", self.odom.append, depth=10),
            ros.subscribe(TFMessage, "/tf", self._framed, depth=10),
        ]
        self.velocity = ros.publisher(Twist, f"/{machine}/{self.border.cmd_vel}")
        self.fault = ros.publisher(String, f"/{machine}/sim/fault")
        self._environment = {**os.environ, **environment.environment(load_site(str(file)))}
        self.running: dict[str, programs.Program] = {}
        for name in processes:
            self.start(name.format(machine))
        self.until(lambda: bool(self.states and self.odom and self.frames), "telemetry")

    @property
    def process(self) -> programs.Program:
        """The stand-in itself."""
        return self.running[f"sim:{self.machine}"]

    def start(self, name: str) -> None:
        self.running[name] = programs.process(name, self._environment, self._log)

    def _framed(self, message: Any) -> None:
        self.frames.update(
            {one.child_frame_id: one for one in message.transforms if self.machine in one.child_frame_id}
        )

    def until(self, there: Callable[[], bool], what: str) -> None:
        wait_until(there, LIMIT, lambda: f"{what}\n{self._log.read_text()}")

    def send(self, action: Any, field: str, **goal: Any) -> Call:
        peer = self.ros.peer(action, f"/{self.machine}/{getattr(self.border, field)}")
        self.until(peer.ready, field)
        return peer.send(action.Goal(**goal), on_feedback=self.said.append)

    def end(self, call: Call) -> Outcome:
        self.until(lambda: call.outcome is not None, "end of the goal")
        assert call.outcome is not None
        return call.outcome

    def cancel(self, action: Any, field: str, call: Call) -> None:
        self.ros.peer(action, f"/{self.machine}/{getattr(self.border, field)}").cancel(call)

    def place(self) -> tuple[float, float]:
        at = self.frames[self.border.base_frame].transform.translation
        return at.x, at.y

    def be(self, **fault: object) -> None:
        """Switch a fault on, or all off, from soon on."""
        self.fault.publish(String(data=json.dumps(fault)))

    def be_in_order(self) -> None:
        """No fault any more; waits until that is seen. Said again and again: a new process may not hear it yet."""
        angle = self.states[-1].position[1]
        for fault, end in (({"refuse": ["set_dump_angle"]}, Outcome.REJECTED), ({}, Outcome.SUCCEEDED)):
            self._until_dump_ends(fault, angle, end)

    def _until_dump_ends(self, fault: dict[str, object], angle: float, end: Outcome) -> None:
        def tried() -> bool:
            self.be(**fault)
            return self.end(self.send(SetDumpAngle, "set_dump_angle", target_angle=angle)) is end

        self.until(tried, f"fault {fault}")

    def close(self) -> None:
        for process in self.running.values():
            process.terminate()
        try:
            for process in self.running.values():
                process.wait(30)
        finally:
            for process in self.running.values():
                process.kill()
            for one in self._subscriptions:
                self.ros.node.destroy_subscription(one)


def pose(x: float, y: float, yaw: float = 0.0) -> PoseStamped:
    made = PoseStamped()
    made.header.frame_id = "map"
    made.pose.position.x, made.pose.position.y = float(x), float(y)  # rclpy sends an int as 0.0
    made.pose.orientation.z, made.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return made


@contextmanager
def client_in(folder: Path, domain: int, port: int) -> Iterator[Ros]:
    """A ROS node in the domain of the tests."""
    file = folder / "site.yaml"
    file.write_text(SITE.format(domain=domain, port=port, names="sim", machine="nobody", model="mst110cr"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(domain))
        patch.setenv("TMS_STATE", str(folder / "state"))
        for key, value in environment.environment(load_site(str(file))).items():
            patch.setenv(key, value)
        ros = Ros("sim_client")
        yield ros
        ros.close()
