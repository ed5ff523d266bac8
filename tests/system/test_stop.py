"""Stop, latch, re-arm, fencing numbers, and a scheduler that is killed, on real processes."""

import json
import os
import signal
import threading
from array import array
from typing import Any

import pytest
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from std_msgs.msg import Bool
from test_mesh import CHANGE_POSE, FEW_SWINGS, ONE_MOVE, events, newest, processes, run, stops, swinging
from tms_msg_host.msg import Processes
from tms_msg_rc.msg import MachineState
from tms_msg_ts.msg import RunStates
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from conftest import CLI, Mesh, wait_until
from tms_decision.owner import Owner
from tms_decision.reasons import HeldByAnother, MachineLatched, NoPermit, OldRun, SoftwareStop
from tms_reason import wire
from tms_ros.goals import Outcome
from tms_ros.node import Ros
from tms_runtime.fence import goal_id

pytestmark = pytest.mark.system
JOINTS = ["swing_joint", "boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint"]


def ask_to_move(node: Ros, goal_id: bytes | None = None) -> Any:
    """A foreign client's goal: a little swing. Returns the ended call."""
    peer = node.peer(FollowJointTrajectory, "/zx200/rc/follow_joint_trajectory")
    peer.wait_ready(10)
    point = JointTrajectoryPoint(
        positions=array("d", [0.2, -0.9, 2.0, 0.5, 0.0]), time_from_start=Duration(sec=8, nanosec=0)
    )
    goal = FollowJointTrajectory.Goal(trajectory=JointTrajectory(joint_names=JOINTS, points=[point]))
    call = peer.send(goal, goal_id=goal_id)
    assert call.wait_for(lambda: call.outcome is not None, 40)
    return call


def rearm(mesh: Mesh) -> None:
    wait_until(
        lambda: mesh.tms("rearm", "zx200", "--yes", expect=None).returncode == 0, 30, "zx200 can be re-armed", every=CLI
    )


def test_after_a_software_stop_nothing_moves_until_somebody_rearms(mesh: Mesh, node: Ros) -> None:
    with swinging(mesh, node) as client:
        receipts = json.loads(mesh.tms("stop", "--json").stdout)
        out = client.output(60)
    assert [(row["machine"], row["confirmed"], row["latched"]) for row in receipts] == [("zx200", True, True)]
    answer = json.loads(out)
    assert answer["outcome"] == "cancelled"
    assert any("software stop" in row["text"] for row in events(mesh, answer["run_id"]))
    refused = ask_to_move(node)
    assert refused.outcome is Outcome.ABORTED
    assert wire.known(refused.result.error_string).find(MachineLatched) is not None
    assert "rearm" in mesh.tms("run", "1", "--wait", expect=1).stderr
    rearm(mesh)
    assert ask_to_move(node).outcome is Outcome.SUCCEEDED


def test_a_stop_while_a_run_prepares_keeps_it_from_moving(mesh: Mesh, node: Ros) -> None:
    """The scheduler stands behind a run when its processes are there; a machine stopped before stays stopped."""
    host, reported = processes(mesh)["tms:host"]["pid"], dict[str, str]()
    receive = lambda message: reported.update((row.name, row.state) for row in message.processes)  # noqa: E731
    received = node.subscribe(Processes, "/tms/host/processes", receive, depth=10, latched=True)
    mesh.tms("stop-process", CHANGE_POSE)
    wait_until(lambda: reported.get(CHANGE_POSE) == "STOPPED", 60, "the scheduler is told, too")
    prepares = threading.Event()
    look = lambda message: any(one.state == "preparing" for one in message.runs) and prepares.set()  # noqa: E731
    seen = node.subscribe(RunStates, "/tms/runs", look, latched=True)
    os.kill(host, signal.SIGSTOP)  # it is the one who starts a run's processes
    answers: list[Any] = []
    client = threading.Thread(target=lambda: answers.append(mesh.tms("run", "1", "--wait", "--json", expect=None)))
    try:
        client.start()
        assert prepares.wait(60)
        mesh.tms("stop")
    finally:
        os.kill(host, signal.SIGCONT)
        node.node.destroy_subscription(received)
        node.node.destroy_subscription(seen)
    client.join(60)
    answer = json.loads(answers[0].stdout)
    assert (answer["outcome"], answer["error_code"]) == ("refused", "NOT_ARMED")
    assert "software stop" in answer["error_msg"]
    assert not [row for row in events(mesh, answer["run_id"]) if row["kind"] == "goal"]
    rearm(mesh)
    assert run(mesh, ONE_MOVE)["outcome"] == "success"


def test_rearming_takes_two_steps_and_is_refused_while_the_stop_is_pressed(mesh: Mesh, node: Ros) -> None:
    latched = threading.Event()
    received = node.subscribe(
        MachineState, "/zx200/rc/state", lambda state: state.latch and latched.set(), latched=True
    )
    button = node.publisher(Bool, "/emergency_signal")
    timer = node.every(0.01, lambda: button.publish(Bool(data=True)))  # as the C++ button does
    try:
        assert latched.wait(20)
        assert "still pressed" in mesh.tms("rearm", "zx200", "--yes", expect=1).stderr
    finally:
        node.node.destroy_timer(timer)
        button.publish(Bool(data=False))
        node.node.destroy_subscription(received)
    rearm(mesh)
    assert "nothing to do" in mesh.tms("rearm", "zx200", "--yes", expect=1).stderr


def test_a_press_outlives_a_frozen_gateway_and_the_host_agent(mesh: Mesh, node: Ros) -> None:
    gateway, host = (processes(mesh)[name]["pid"] for name in ("zx200:rc", "tms:host"))
    button, note = node.publisher(Bool, "/emergency_signal"), mesh.state / "rc" / "zx200.pressed"
    os.kill(gateway, signal.SIGSTOP)
    timer = node.every(0.05, lambda: button.publish(Bool(data=True)))
    try:
        wait_until(note.exists, 20, "the press is on the disk")
    finally:
        node.node.destroy_timer(timer)
        for pid in (gateway, host):
            os.kill(pid, signal.SIGKILL)
    button.publish(Bool(data=False))
    mesh.wait_ready()
    latched = wire.known(ask_to_move(node).result.error_string).find(MachineLatched)
    assert latched is not None and latched.cause.find(SoftwareStop) is not None
    rearm(mesh)


def test_goals_of_an_abandoned_run_are_refused(mesh: Mesh, node: Ros) -> None:
    refused = ask_to_move(node, goal_id(Owner(7, 1, 1)))
    assert refused.outcome is Outcome.ABORTED and wire.known(refused.result.error_string).find(NoPermit) is not None
    with swinging(mesh, node):
        stale = ask_to_move(node, goal_id(Owner(7, 1, 1)))
        foreign = ask_to_move(node)
        mesh.tms("cancel", newest(mesh))
    assert wire.known(stale.result.error_string).find(OldRun) is not None
    assert wire.known(foreign.result.error_string).find(HeldByAnother) is not None


def test_a_killed_scheduler_leaves_a_run_that_can_be_resumed(mesh: Mesh, node: Ros) -> None:
    run(mesh, ONE_MOVE)
    pid = processes(mesh)["tms:ts"]["pid"]
    with swinging(mesh, node, FEW_SWINGS):
        run_id = newest(mesh)
        os.kill(pid, signal.SIGKILL)
        wait_until(lambda: state_of(mesh, run_id) == "interrupted", 40, "the run is closed as interrupted", every=CLI)
    seen = stops(mesh, run_id)
    assert seen and all(text.startswith("zx200 stood after") for text in seen)
    rearm(mesh)
    mesh.wait_ready()
    done = mesh.tms("resume", run_id, "--yes", "--wait", "--json", limit=120)
    assert json.loads(done.stdout)["outcome"] == "success"
    numbers = [row["number"] for row in events(mesh, run_id)]
    assert numbers == sorted(set(numbers))
    assert "no run" in mesh.tms("abandon", run_id, expect=1).stderr


def state_of(mesh: Mesh, run_id: str) -> str:
    rows = json.loads(mesh.tms("runs", "--limit", "5", "--json").stdout)
    return next((row["state"] for row in rows if row["run_id"] == run_id), "")
