"""A software stop ends every kind of motion that a machine has; and a frozen process is restarted by the host agent."""

import json
import os
import signal
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from geometry_msgs.msg import PoseStamped, Twist
from std_msgs.msg import Bool
from tms_msg_rc.msg import MachineState, StopReceipt

from conftest import GATEWAYS_ONLY, Mesh, mesh_apart, rearm, wait_until
from tms_decision.reasons import SoftwareStop
from tms_machine.border import MOTIONS, MotionAction
from tms_reason.wire import to_line
from tms_ros.goals import Outcome
from tms_ros.node import Ros

pytestmark = [pytest.mark.ros, pytest.mark.timeout(300)]
MACHINE = "mst110cr_2"  # has all kinds of motion but a trajectory, which tests of the whole mesh stop


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Mesh, Ros]]:
    """One machine without scheduler, database and console."""
    changes = {**GATEWAYS_ONLY, "machines": {MACHINE: {"model": "mst110cr"}}, "on_loss": {"frozen": 6.0}}
    with mesh_apart(tmp_path_factory.mktemp("small"), **changes) as mesh:
        mesh.tms("up")
        try:
            ros = Ros("tms_tests_stops")
            yield mesh, ros
            ros.close()
        finally:
            mesh.tms("down")


class Watch:
    """What is heard of the machine."""

    def __init__(self, ros: Ros) -> None:
        self.changed = threading.Condition()
        self.state: Any = None
        self.zeros, self.receipts = 0, []  # type: ignore[var-annotated]
        ros.subscribe(MachineState, f"/{MACHINE}/rc/state", self._state, latched=True)
        ros.subscribe(StopReceipt, f"/{MACHINE}/rc/receipts", self._receipt, depth=20, latched=True)
        ros.subscribe(Twist, f"/{MACHINE}/cmd_vel", self._zero, depth=10)

    def _state(self, state: Any) -> None:
        with self.changed:
            self.state = state
            self.changed.notify_all()

    def _receipt(self, receipt: Any) -> None:
        with self.changed:
            self.receipts.append(receipt)
            self.changed.notify_all()

    def _zero(self, twist: Twist) -> None:
        with self.changed:
            self.zeros += twist == Twist()
            self.changed.notify_all()

    def wait(self, holds: Any, what: str) -> None:
        with self.changed:
            assert self.changed.wait_for(holds, 60), f"not within 60 s: {what}"


@pytest.fixture(scope="module")
def watch(small: tuple[Mesh, Ros]) -> Watch:
    return Watch(small[1])


def far_away(motion: MotionAction, number: int) -> Any:
    """A goal that lasts for some seconds."""
    there = PoseStamped()
    there.header.frame_id = "map"
    there.pose.position.x, there.pose.position.y = 60.0 + 30.0 * (number % 2), 40.0 - 30.0 * (number % 2)
    there.pose.orientation.w = 1.0
    goal = motion.type.Goal()
    if hasattr(goal, "pose"):
        goal.pose = there
    elif hasattr(goal, "poses"):
        goal.poses = [there] if isinstance(goal.poses, list) else type(goal.poses)(header=there.header, goals=[there])
    else:
        goal.target_angle = -0.9 if motion.field == "set_dump_angle" else 1.5
    return goal


@pytest.fixture(autouse=True)
def armed(small: tuple[Mesh, Ros], watch: Watch) -> None:
    """A latched machine would refuse the goal that a test wants to stop."""
    watch.wait(lambda: watch.state is not None and watch.state.ready, "the machine is ready")
    wait_until(lambda: rearm(small[1], MACHINE), 60, f"{MACHINE} is armed")


NOT_THERE = ("trajectory", "follow_path", "set_bulldozer_blade")  # a carrier has no arm, stand-ins follow no told path


@pytest.mark.parametrize("motion", [m for m in MOTIONS if m.field not in NOT_THERE], ids=lambda motion: motion.field)
def test_a_software_stop_ends_every_kind_of_motion(small: tuple[Mesh, Ros], watch: Watch, motion: MotionAction) -> None:
    ros = small[1]
    button = ros.publisher(Bool, "/emergency_signal")
    peer = ros.peer(motion.type, f"/{MACHINE}/rc/{motion.served}")
    peer.wait_ready(30)
    wait_until(lambda: button.get_subscription_count() > 0, 30, "the gateway hears the button")
    call = peer.send(far_away(motion, MOTIONS.index(motion)))
    watch.wait(lambda: (watch.state.moving and watch.state.goal) or call.outcome, "it moves")
    assert call.outcome is None, call.result
    before, zeros = len(watch.receipts), watch.zeros
    button.publish(Bool(data=True))
    assert call.wait_for(lambda: call.outcome is not None, 30) and call.outcome is Outcome.ABORTED, call.result
    watch.wait(lambda: len(watch.receipts) > before, "a receipt")
    receipt = watch.receipts[-1]
    assert (receipt.confirmed, receipt.latched, receipt.cause) == (True, True, to_line(SoftwareStop()))
    watch.wait(lambda: watch.zeros > zeros, "zero velocities")
    late = peer.send(far_away(motion, MOTIONS.index(motion)))  # whoever asks now
    assert late.wait_for(lambda: late.outcome is not None, 30) and late.outcome is not Outcome.SUCCEEDED
    assert not watch.state.moving
    button.publish(Bool(data=False))


def test_a_release_does_not_push_out_the_stop_before_it(small: tuple[Mesh, Ros], watch: Watch) -> None:
    """A button that springs back, while the gateway is too busy to look at either message."""
    mesh, ros = small
    button = ros.publisher(Bool, "/emergency_signal")
    wait_until(lambda: button.get_subscription_count() > 0, 30, "the gateway hears the button")
    rows = json.loads(mesh.tms("ps", "--json").stdout)
    pid = next(int(row["pid"]) for row in rows if row["name"] == f"{MACHINE}:rc")
    before = len(watch.receipts)
    os.kill(pid, signal.SIGSTOP)
    try:
        button.publish(Bool(data=True))
        button.publish(Bool(data=False))
    finally:
        os.kill(pid, signal.SIGCONT)
    watch.wait(lambda: len(watch.receipts) > before, "a receipt")
    watch.wait(lambda: watch.state.latch == to_line(SoftwareStop()), "the latch")


def test_a_frozen_process_is_restarted(small: tuple[Mesh, Ros], watch: Watch) -> None:
    mesh, ros = small

    def pid() -> int:
        rows = json.loads(mesh.tms("ps", "--json").stdout)
        return next(int(row["pid"]) for row in rows if row["name"] == f"{MACHINE}:rc")

    threading.Event().wait(2.5)  # until the host agent has asked it once
    old = pid()
    os.kill(old, signal.SIGSTOP)
    watch.state = None
    wait_until(lambda: pid() not in (0, old), 60, "the frozen gateway is replaced")
    log = next(Path(mesh.state, "log").glob("tms.host.log")).read_text()
    assert f"event=frozen target={MACHINE}:rc" in log
    watch.wait(lambda: watch.state is not None and watch.state.ready, "the new gateway is heard")
    # Until then a client takes the dead server for the new one, and a goal sent to it is lost.
    states = f"/{MACHINE}/rc/state"
    wait_until(lambda: ros.node.count_publishers(states) == 1, 60, "the old gateway has left discovery")
