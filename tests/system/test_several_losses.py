"""Several processes of a run killed or frozen at once: while gateway or host agent is left, the machine is stopped."""

import os
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import psutil
import pytest
from action_msgs.msg import GoalStatus, GoalStatusArray
from std_msgs.msg import Bool
from test_mesh import processes, swinging

from conftest import CLI, PROJECT, Mesh, mesh_apart, running, wait_until
from tms_ros.node import Ros

pytestmark = [pytest.mark.turns, pytest.mark.system, pytest.mark.timeout(300)]
STATUS = "/zx200/upper_arm_controller/follow_joint_trajectory/_action/status"
OPEN = (GoalStatus.STATUS_ACCEPTED, GoalStatus.STATUS_EXECUTING)
STOPPED = (GoalStatus.STATUS_CANCELING, GoalStatus.STATUS_CANCELED)


@pytest.fixture(scope="module")
def slow(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Mesh, Ros]]:
    """A mesh at the machine's own speed, so that a swing outlasts every loss."""
    with mesh_apart(tmp_path_factory.mktemp("slow"), sim={"speed": 1.0}) as mesh:
        with running(mesh):
            mesh.tms("param", "load", str(PROJECT / "tests" / "data" / "swings.yaml"))
            mesh.tms("task", "add", str(PROJECT / "tests" / "data" / "swings.xml"))
            ros = Ros("tms_tests_slow")
            yield mesh, ros
            ros.close()


class Controller:
    """What the machine's own controller is told."""

    def __init__(self, ros: Ros) -> None:
        self.statuses: dict[bytes, int] = {}  # of goals, in the order of their begin
        self.emergency = False
        self.pids: list[int] = []  # of the mesh
        self._ends = [
            ros.subscribe(GoalStatusArray, STATUS, self._status, depth=20, latched=True),  # as actions offer it
            ros.subscribe(Bool, "/zx200/emg_stop", self._emergency, depth=20),
        ]
        self._ros = ros

    def _status(self, message: Any) -> None:
        for status in message.status_list:
            self.statuses[bytes(status.goal_info.goal_id.uuid)] = status.status

    def _emergency(self, message: Any) -> None:
        self.emergency = self.emergency or message.data

    def open(self) -> list[bytes]:
        return [goal for goal, status in list(self.statuses.items()) if status in OPEN]

    def close(self) -> None:
        for end in self._ends:
            self._ros.node.destroy_subscription(end)


@contextmanager
def struck(slow: tuple[Mesh, Ros], names: list[str], number: signal.Signals) -> Iterator[tuple[Controller, bytes]]:
    """A run whose machine swings while these processes get a signal; inside: the goal that was open then."""
    mesh, ros = slow
    in_order(slow)
    controller = Controller(ros)
    try:
        with swinging(mesh, ros, "1"):
            found = processes(mesh)
            controller.pids = [row["pid"] for row in found.values() if row["pid"]]
            pids = [row["pid"] for name, row in found.items() if row["pid"] and fits(name, names)]
            pids += [int((mesh.state / "supervisord.pid").read_text())] if "supervisord" in names else []
            assert len(pids) >= len(names)
            wait_until(lambda: bool(controller.open()), 60, "the controller follows a trajectory")
            goal = controller.open()[-1]
            for pid in pids:
                os.kill(pid, number)
            yield controller, goal
            if number == signal.SIGSTOP:
                for pid in pids:
                    with suppress(ProcessLookupError):  # the gateway was replaced
                        os.kill(pid, signal.SIGCONT)
    finally:
        controller.close()


def fits(name: str, wanted: list[str]) -> bool:
    """`subtasks` stands for all of them."""
    return name in wanted or ("subtasks" in wanted and name.startswith(("zx200:subtask", "zx200:st_")))


def in_order(slow: tuple[Mesh, Ros]) -> None:
    """Nothing runs and the machine is armed, whatever the test before has left."""
    mesh, ros = slow
    mesh.wait_ready()
    ros.publisher(Bool, "/zx200/emg_stop").publish(Bool(data=False))
    wait_until(lambda: armed(mesh), 60, "zx200 can be re-armed", 0.5)


def armed(mesh: Mesh) -> bool:
    """Whether it could be re-armed: a run that just ends, or a gateway that just began, refuses for a while."""
    mesh.tms("cancel", "last", expect=None)
    mesh.tms("abandon", "last", expect=None)
    return mesh.tms("rearm", "--all", "--yes", expect=None).returncode == 0


def stopped_after(controller: Controller, goal: bytes, capsys: pytest.CaptureFixture[str]) -> None:
    """The goal, which would last for some seconds more, is cancelled, or `emg_stop`, another topic, came first."""
    begun = time.monotonic()
    wait_until(lambda: controller.statuses[goal] not in OPEN, 60, "the goal ends", 0.005)
    if controller.statuses[goal] == GoalStatus.STATUS_ABORTED:
        wait_until(lambda: controller.emergency, 30, "the stop that ended it")
    else:
        assert controller.statuses[goal] in STOPPED
    with capsys.disabled():
        print(f"\nloss to stop: {time.monotonic() - begun:.2f} s")


@pytest.mark.parametrize(
    "names",
    [["zx200:rc"], ["zx200:rc", "tms:ts"], ["zx200:rc", "tms:ts", "zx200:rp", "subtasks"]],
    ids=lambda names: "+".join(names),
)
def test_a_machine_whose_processes_are_killed_is_stopped(
    slow: tuple[Mesh, Ros], names: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with struck(slow, names, signal.SIGKILL) as (controller, goal):
        stopped_after(controller, goal, capsys)
        if "tms:ts" in names:
            wait_until(lambda: controller.emergency, 30, "emg_stop, as the run is lost, too")


@pytest.mark.parametrize("names", [["zx200:rc"], ["zx200:rc", "tms:ts"]], ids=lambda names: "+".join(names))
def test_a_machine_whose_processes_are_frozen_is_stopped(
    slow: tuple[Mesh, Ros], names: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    gateway = processes(slow[0])["zx200:rc"]["pid"]
    with struck(slow, names, signal.SIGSTOP) as (controller, goal):
        stopped_after(controller, goal, capsys)
        assert psutil.Process(gateway).status() == psutil.STATUS_STOPPED  # so it was not the gateway itself
        wait_until(lambda: controller.emergency, 30, "emg_stop")
        wait_until(
            lambda: processes(slow[0])["zx200:rc"]["pid"] not in (0, gateway), 60, "the gateway is replaced", every=CLI
        )


@pytest.mark.parametrize("names", [["supervisord"], ["supervisord", "tms:ts"]], ids=lambda names: "+".join(names))
def test_without_supervisord_the_gateway_stops_the_machine_before_it_ends(
    slow: tuple[Mesh, Ros], names: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    mesh = slow[0]
    with struck(slow, names, signal.SIGKILL) as (controller, goal):
        stopped_after(controller, goal, capsys)
    wait_until(lambda: not any(map(psutil.pid_exists, controller.pids)), 30, "the processes have ended")
    mesh.tms("up")
