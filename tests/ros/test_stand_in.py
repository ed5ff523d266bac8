"""The host agent stops a machine in place of its gateway: no scheduler, database or console is there to do it."""

import os
import re
import signal
import threading
import time
from array import array
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from typing import Any

import psutil
import pytest
from action_msgs.msg import GoalStatus, GoalStatusArray
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from std_msgs.msg import Bool
from tms_msg_rc.msg import MachineState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from conftest import CLI, GATEWAYS_ONLY, Mesh, mesh_apart, running, wait_until
from tms_config.config import load_site
from tms_decision.reasons import SoftwareStop
from tms_host.supervisor import Supervisor
from tms_reason.wire import to_line
from tms_ros.goals import Outcome
from tms_ros.node import Ros

pytestmark = [pytest.mark.turns, pytest.mark.ros, pytest.mark.timeout(300)]
JOINTS = ["swing_joint", "boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint"]
START = [0.0, -0.8029, 1.9897, 0.8029, 0.0]  # rad
STOPPED = (
    GoalStatus.STATUS_CANCELING,
    GoalStatus.STATUS_CANCELED,
    GoalStatus.STATUS_ABORTED,
)  # by emg_stop, where a busy PC carries the request to cancel later
SHORT, MOST = 0.4, 0.45  # s; a test that does not run itself freezes for longer than it wants
ATTEMPTS = 5
DROPPED = 8.0  # s after which discovery counts a killed process no more


class Small:
    """A mesh of host agent, gateway and stand-in, and what is heard of the machine."""

    def __init__(self, mesh: Mesh, supervisor: Supervisor, ros: Ros) -> None:
        self.mesh, self._supervisor = mesh, supervisor
        self.state: Any = None
        self.statuses: dict[bytes, list[int]] = {}  # of goals at the machine's own controller, in order
        self.emergencies = 0
        self.changed = threading.Condition()
        self.peer = ros.peer(FollowJointTrajectory, "/zx200/rc/follow_joint_trajectory")
        status = "/zx200/upper_arm_controller/follow_joint_trajectory/_action/status"
        ros.subscribe(GoalStatusArray, status, self._status, depth=20, latched=True)  # as actions offer it
        ros.subscribe(MachineState, "/zx200/rc/state", self._state, latched=True)
        ros.subscribe(Bool, "/zx200/emg_stop", self._emergency, depth=20)
        self.release = ros.publisher(Bool, "/zx200/emg_stop")
        self.button = ros.publisher(Bool, "/emergency_signal")

    def _status(self, message: Any) -> None:
        with self.changed:
            for status in message.status_list:
                seen = self.statuses.setdefault(bytes(status.goal_info.goal_id.uuid), [])
                if status.status not in seen[-1:]:
                    seen.append(status.status)
            self.changed.notify_all()

    def _state(self, message: Any) -> None:
        with self.changed:
            self.state = message
            self.changed.notify_all()

    def _emergency(self, message: Any) -> None:
        with self.changed:
            self.emergencies += message.data
            self.changed.notify_all()

    def wait(self, holds: Any, what: str) -> None:
        with self.changed:
            assert self.changed.wait_for(holds, 60), f"not within 60 s: {what}\n{self.told()}"

    def told(self) -> str:
        """What was heard of the machine, and the last lines that its processes have logged."""
        logs = sorted((self.mesh.state / "log").glob("*.log"))
        lines = [f"{log.name}: {line}" for log in logs for line in log.read_text().splitlines()[-30:]]
        return "\n".join([f"{self.state}", f"{list(self.statuses.values())}", *lines])

    def pid(self) -> int:
        return self._supervisor.process("zx200:rc").pid

    def log(self) -> str:
        return (self.mesh.state / "log" / "tms.host.log").read_text()

    def reported(self, event: str, begin: int) -> bool:
        """Whether the host agent's log has an event behind `begin` characters."""
        return re.search(rf"machine=zx200 event={event}\b", self.log()[begin:]) is not None

    def wait_armed(self) -> None:
        """Ready for a goal, whatever the test before has left."""
        self.wait(lambda: self.state is not None and self.state.ready, "it is ready")
        self.wait(lambda: not self.state.moving and not self.state.goal, "it stands")
        wait_until(self._rearmed, 60, "it is armed", every=CLI)  # its gateway may just be replaced
        self.release.publish(Bool(data=False))

    def _rearmed(self) -> bool:
        return self.mesh.tms("rearm", "--all", "--yes", expect=None).returncode == 0

    @contextmanager
    def moving(self, seconds: float) -> Iterator[tuple[Any, list[int]]]:
        """A foreign client's goal to and fro; inside it moves: its call, and its statuses at the controller."""
        self.wait_armed()
        self.peer.wait_ready(30)
        known = set(self.statuses)
        points = [
            JointTrajectoryPoint(positions=array("d", [swing, *START[1:]]), time_from_start=_duration(at))
            for swing, at in ((0.5, seconds / 2), (0.0, seconds))
        ]
        call = self.peer.send(FollowJointTrajectory.Goal(trajectory=JointTrajectory(joint_names=JOINTS, points=points)))
        moves = lambda: self.state.moving and self.state.goal and set(self.statuses) - known  # noqa: E731
        self.wait(lambda: call.outcome is not None or moves(), "it moves")
        assert call.outcome is None, call.result
        yield call, self.statuses[(set(self.statuses) - known).pop()]


def age(pid: int) -> float:
    """How long a process is there [s]."""
    return time.time() - psutil.Process(pid).create_time()


def _duration(seconds: float) -> Duration:
    return Duration(sec=int(seconds), nanosec=int(seconds % 1 * 1e9))


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Small]:
    with mesh_apart(tmp_path_factory.mktemp("small"), **GATEWAYS_ONLY, sim={"speed": 1.0}) as mesh:
        site = load_site()
        with running(mesh):
            ros, supervisor = Ros("tms_tests_stand_in"), Supervisor(site)
            with closing(ros), closing(supervisor):
                yield Small(mesh, supervisor, ros)


def test_a_killed_gateway_is_stood_in_for(small: Small, capsys: pytest.CaptureFixture[str]) -> None:
    with small.moving(20.0) as (_, statuses):
        begin, pid = len(small.log()), small.pid()
        at = time.monotonic()
        os.kill(pid, signal.SIGKILL)
        small.wait(lambda: statuses[-1] in STOPPED, "the controller is told to stop")
        with capsys.disabled():
            print(f"\nkill to stop: {time.monotonic() - at:.2f} s")
    wait_until(lambda: small.reported("gateway_lost", begin), 30, "the host agent tells of it")
    wait_until(lambda: small.reported("gateway_back", begin), 60, "its successor is there")


def test_a_press_while_the_gateway_is_away_latches_its_successor(small: Small) -> None:
    small.wait_armed()
    wait_until(lambda: small.button.get_subscription_count() >= 2, 30, "gateway and host agent hear the button")
    os.kill(small.pid(), signal.SIGKILL)
    small.button.publish(Bool(data=True))
    small.button.publish(Bool(data=False))
    small.wait(lambda: small.state.latch == to_line(SoftwareStop()), "its successor is latched")


def test_a_frozen_gateway_is_stood_in_for_and_replaced(small: Small, capsys: pytest.CaptureFixture[str]) -> None:
    with small.moving(20.0) as (_, statuses):
        wait_until(lambda: age(small.pid()) > 5.0, 30, "it is no new one")
        begin, pid, before = len(small.log()), small.pid(), small.emergencies
        at = time.monotonic()
        os.kill(pid, signal.SIGSTOP)
        small.wait(lambda: statuses[-1] in STOPPED, "the controller is told to stop")
        assert psutil.Process(pid).status() == psutil.STATUS_STOPPED  # so nobody else has done it
        with capsys.disabled():
            print(f"\nfreeze to stop: {time.monotonic() - at:.2f} s")
        small.wait(lambda: small.emergencies > before, "emg_stop")
    wait_until(lambda: small.pid() not in (0, pid), 60, "the frozen gateway is replaced")
    assert f"event=frozen target=zx200:rc pid={pid} action=killed" in small.log()[begin:]
    wait_until(lambda: small.reported("gateway_back", begin), 60, "its successor is there")


def test_a_freeze_of_less_than_half_a_second_stops_nothing(small: Small) -> None:
    for _ in range(ATTEMPTS):
        with small.moving(10.0) as (call, statuses):
            begin, pid = len(small.log()), small.pid()
            longest = max(frozen_for_a_moment(pid, 0.6 + 0.017 * i) for i in range(6))
            assert call.wait_for(lambda: call.outcome is not None, 60)
        if longest <= MOST:
            assert call.outcome is Outcome.SUCCEEDED, call.result
            assert statuses[-1] == GoalStatus.STATUS_SUCCEEDED
            assert not small.reported("gateway_lost", begin)
            return
    pytest.fail(f"this PC is too busy: {ATTEMPTS} times a freeze of more than {MOST} s")


def frozen_for_a_moment(pid: int, then: float) -> float:
    """Freeze a process; how long it was [s]. Afterwards wait, so that the next one meets another time between beats."""
    with at_once():
        os.kill(pid, signal.SIGSTOP)
        begun = time.monotonic()
        time.sleep(SHORT)
        os.kill(pid, signal.SIGCONT)
        took = time.monotonic() - begun
    time.sleep(then)
    return took


@contextmanager
def at_once() -> Iterator[None]:
    """Inside, this thread runs whenever it wants to, also on a busy PC, if the user may ask for that."""
    usual = os.sched_getscheduler(0), os.sched_getparam(0)
    with suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
    try:
        yield
    finally:
        os.sched_setscheduler(0, *usual)


def test_an_idle_machine_whose_gateway_is_frozen_gets_no_emg_stop(small: Small) -> None:
    small.wait_armed()
    begin, before = len(small.log()), small.emergencies
    os.kill(small.pid(), signal.SIGSTOP)
    wait_until(lambda: small.reported("gateway_lost", begin), 30, "the host agent tells of it")
    wait_until(lambda: small.reported("gateway_back", begin), 60, "its successor is there")
    assert small.emergencies == before


def test_a_restart_by_hand_is_no_loss(small: Small) -> None:
    small.wait_armed()
    wait_until(lambda: age(small.pid()) > DROPPED, 30, "its predecessor is forgotten, if that was killed")
    begin, old = len(small.log()), small.pid()
    small.mesh.tms("restart", "zx200:rc")
    wait_until(lambda: small.reported("gateway_left", begin), 30, "the host agent has seen it leave")
    small.state = None
    wait_until(lambda: small.pid() not in (0, old), 60, "the gateway is there again")
    small.wait(lambda: small.state is not None and small.state.ready, "it works")
    assert not small.reported("gateway_lost", begin)
