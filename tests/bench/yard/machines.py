"""Twenty machines in one process: their action servers and news, and when each gateway sent its zero velocities."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from array import array
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from http import HTTPStatus
from http.client import HTTPConnection
from pathlib import Path
from typing import Any

import yaml
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from tms_msg_rc.srv import Rearm
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from conftest import ports_of, site_data
from tms_config.config import Site, load_site
from tms_reason.errors import RosError
from tms_ros.client import Call
from tms_ros.goals import Ended, Outcome
from tms_ros.node import Ros
from tms_ros.server import Goal
from tms_runtime import environment
from tms_runtime.priority import URGENT, undisturbed

COUNT = 20
MODEL = "zx200"
STATE_PERIOD = 0.1  # s between joint states
LIMIT = 60.0  # s for anything to happen; only bounds a hang
ANSWER_LIMIT = 3.0  # s for one answer
BURN = "import os; os.setpriority(os.PRIO_PROCESS, 0, 0)\nwhile True: pass"
ARMED = ("", "NOT_STOPPED")
HURRY = -10  # nice value of the yard: machines and buttons have PCs of their own


def names() -> list[str]:
    return [f"m{number}" for number in range(COUNT)]


def make_site(folder: Path, domain: int) -> Site:
    machines = {name: {"model": MODEL} for name in names()}
    file = folder / "site.yaml"
    file.write_text(yaml.safe_dump(site_data(domain, ports_of(domain), machines=machines, services={"ur": {}})))
    os.environ.update({"TMS_SITE": str(file), "TMS_STATE": str(folder / "state")})
    os.environ.pop("ROS_DOMAIN_ID", None)
    site = load_site()
    environment.enter(site)
    return site


def hurry() -> None:
    """Let this process and those that it starts go before the gateways, as far as the system allows it."""
    with suppress(PermissionError):
        os.setpriority(os.PRIO_PROCESS, 0, HURRY)


@contextmanager
def process(*words: str, **settings: Any) -> Iterator[subprocess.Popen[str]]:
    """A Python process that is killed at the end."""
    with subprocess.Popen([sys.executable, *words], text=True, **settings) as running:
        try:
            yield running
        finally:
            running.send_signal(signal.SIGKILL)


def motion(model: Any) -> FollowJointTrajectory.Goal:
    """A minute of standing: the stand-ins end it only when they are told to."""
    joints = list(model.joints)
    angles = [(joint.min + joint.max) / 2 if joint.min is not None else 0.0 for joint in model.joints.values()]
    point = JointTrajectoryPoint(positions=array("d", angles), time_from_start=Duration(sec=60, nanosec=0))
    return FollowJointTrajectory.Goal(trajectory=JointTrajectory(joint_names=joints, points=[point]))


def why_not_armed(ros: Ros, name: str) -> str:
    """Try to arm a machine; the code of why it is not, one of ARMED if it is."""
    try:
        first = ros.call(Rearm, f"/{name}/rearm", Rearm.Request(), ANSWER_LIMIT)
        if first.error_code:
            return str(first.error_code)
        armed = ros.call(Rearm, f"/{name}/rearm", Rearm.Request(token=first.token), ANSWER_LIMIT)
    except RosError as error:  # a service drops its answer to a client that it has not found yet
        return error.code
    return str(armed.error_code)


class Yard:
    """The machines, and everything that a benchmark asks of their gateways."""

    def __init__(self, site: Site) -> None:
        self.ros = Ros("bench_yard")
        self._site, self._model = site, site.models[MODEL]
        self._changed = threading.Condition()
        self.zeros: dict[str, int] = {}  # machine -> ns since 1970 at which its gateway sent the first zero velocities
        self.running: set[str] = set()  # machines with an open goal
        self._publishers = [self._machine(name, site.border(name)) for name in names()]
        self._button = self.ros.publisher(Bool, "/emergency_signal")
        self.ros.every(STATE_PERIOD, self._news)

    def _machine(self, name: str, border: Any) -> tuple[Any, Any]:
        ros = self.ros
        ros.serve(FollowJointTrajectory, f"/{name}/{border.trajectory}", lambda goal: self._run(name, goal))
        ros.node.create_subscription(
            Twist,
            f"/{name}/{border.cmd_vel}",
            lambda _zero, info: self._zero(name, info),
            10,
            callback_group=ros.loop.group,
        )
        joints = ros.publisher(JointState, f"/{name}/{border.joint_states}")
        return joints, ros.publisher(Odometry, f"/{name}/{border.odom}")

    def _news(self) -> None:
        zeros = array("d", [0.0] * len(self._model.joints))
        at = motion(self._model).trajectory.points[0].positions
        states, place = JointState(name=list(self._model.joints), position=at, velocity=zeros), Odometry()
        states.header.stamp = place.header.stamp = self.ros.now()
        for joints, odometry in self._publishers:
            joints.publish(states)
            odometry.publish(place)

    def _run(self, name: str, goal: Goal) -> Ended:
        self._note(lambda: self.running.add(name))
        goal.cancelled.wait(LIMIT)
        self._note(lambda: self.running.discard(name))
        return Outcome.CANCELED, FollowJointTrajectory.Result()

    def _zero(self, name: str, info: Any) -> None:
        self._note(lambda: self.zeros.setdefault(name, int(info["source_timestamp"])))

    def _note(self, step: Any) -> None:
        with self._changed:
            step()
            self._changed.notify_all()

    def wait(self, holds: Any, what: str) -> None:
        with self._changed:
            assert self._changed.wait_for(holds, LIMIT), f"not within {LIMIT:.0f} s: {what}"

    def arm(self) -> None:
        """Every machine armed, nothing moves."""
        self._button.publish(Bool(data=False))
        deadline = time.monotonic() + LIMIT
        for name in names():
            while (code := why_not_armed(self.ros, name)) not in ARMED:
                assert time.monotonic() < deadline, f"{name} cannot be armed: {code}"
                time.sleep(0.05)

    def move(self) -> None:
        """One goal a machine, of a foreign client, and all of them run."""
        calls = {name: self._goal(name) for name in names()}

        def again() -> None:
            for name, call in calls.items():
                if call.outcome is not None and name not in self.running:
                    calls[name] = self._goal(name)

        self.wait_moving(again)

    def _goal(self, name: str) -> Call:
        peer = self.ros.peer(FollowJointTrajectory, f"/{name}/rc/follow_joint_trajectory")
        peer.wait_ready(LIMIT)
        return peer.send(motion(self._model))

    def wait_moving(self, again: Callable[[], None] = lambda: None) -> None:
        """Wait until all machines have a goal.

        A gateway that a busy core kept from running may have stopped its machine before: it is armed `again`.
        """
        deadline = time.monotonic() + LIMIT
        while missing := [name for name in names() if name not in self.running]:
            assert time.monotonic() < deadline, f"not within {LIMIT:.0f} s: goals of {', '.join(missing)} run"
            for name in missing:
                why_not_armed(self.ros, name)
            again()
            time.sleep(0.1)
        with self._changed:
            self.zeros.clear()

    def press(self) -> list[float]:
        """The software stop; ms from the press to each gateway's zero velocities."""
        with undisturbed(URGENT):  # as the console and `tms stop` send it
            begun = time.time_ns()
            self._button.publish(Bool(data=True))
        return self.stopped_since(begun)

    def click(self) -> list[float]:
        """The software stop of the console's API; ms from the request to each gateway's zero velocities."""
        console = HTTPConnection("127.0.0.1", self._site.file.ports.console, timeout=LIMIT)
        console.connect()
        with undisturbed(URGENT):
            begun = time.time_ns()
            console.request("POST", "/api/stop", "{}", {"Content-Type": "application/json"})
        late = self.stopped_since(begun)
        assert console.getresponse().status == HTTPStatus.OK
        console.close()
        return late

    def stopped_since(self, begun: int) -> list[float]:
        """ms from `begun` (ns since 1970) to each gateway's zero velocities."""
        self.wait(lambda: len(self.zeros) == COUNT, "every gateway has sent zero velocities")
        return [(at - begun) / 1e6 for at in self.zeros.values()]
