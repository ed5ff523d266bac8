"""The main job on real processes: run, run again, cancel, kill, restart."""

import json
import os
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import psutil
import pytest
from tms_msg_rc.msg import MachineState

from conftest import CLI, Mesh, wait_until
from lateness import Lateness
from programs import Program, running_tms
from tms_ros.node import Ros

pytestmark = pytest.mark.system
CHANGE_POSE = "zx200:subtask_zx200_change_pose"
FEW_SWINGS, ONE_MOVE = "4", "5"  # tasks of the mesh


def run(mesh: Mesh, *words: str, expect: int = 0) -> dict[str, Any]:
    done = mesh.tms("run", *words, "--wait", "--json", expect=expect)
    answer: dict[str, Any] = json.loads(done.stdout)
    return answer


def processes(mesh: Mesh) -> dict[str, dict[str, Any]]:
    return {row["name"]: row for row in json.loads(mesh.tms("ps", "--json").stdout)}


def events(mesh: Mesh, run_id: str) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = json.loads(mesh.tms("events", run_id, "--json").stdout)
    return rows


def test_a_task_runs_to_success_and_again_without_a_restart(mesh: Mesh) -> None:
    before = {name: row["pid"] for name, row in processes(mesh).items() if row["state"] == "RUNNING"}
    assert [run(mesh, "1")["outcome"] for _ in range(2)] == ["success", "success"]
    after = processes(mesh)
    assert {name: after[name]["pid"] for name in before} == before


def test_nobody_else_reads_the_state_folder(mesh: Mesh) -> None:
    run(mesh, ONE_MOVE)
    places = (mesh.state, *mesh.state.rglob("*"))
    assert {"log", "store", "supervisord.conf", "prometheus", "ros", "tms.ts.log"} <= {path.name for path in places}
    ours = f"_{os.getpid()}_"  # in the name of the log of this test's own node
    others = [path for path in places if path.exists() and ours not in path.name]
    assert [path for path in others if path.stat().st_mode & 0o077] == []


def test_the_history_tells_every_leaf_in_order(mesh: Mesh) -> None:
    run_id = run(mesh, "1")["run_id"]
    rows = events(mesh, run_id)
    assert [row["number"] for row in rows] == list(range(1, len(rows) + 1))
    sent = [row["text"].split("record ")[1] for row in rows if row["kind"] == "goal" and row["text"].startswith("sent")]
    assert sent == [
        "initial_pose", "target_excavate_pose", "hold_soil_while_elevating_pose", "hold_soil_while_turning_pose",
        "target_release_pose", "release_angle",
    ]  # fmt: skip
    assert rows[-1]["kind"] == "run" and rows[-1]["text"] == "success"


@pytest.mark.turns
def test_four_cycles_send_24_goals(mesh: Mesh) -> None:
    answer = run(mesh, "2")
    assert answer["outcome"] == "success"
    goals = [row["text"] for row in events(mesh, answer["run_id"]) if row["kind"] == "goal"]
    assert len([text for text in goals if "succeeded" in text]) == 24  # on a busy PC one may have been sent twice


def test_a_killed_subtask_comes_back_and_the_next_run_works(mesh: Mesh) -> None:
    run(mesh, ONE_MOVE)
    old = processes(mesh)[CHANGE_POSE]["pid"]
    os.kill(old, signal.SIGKILL)
    wait_until(lambda: processes(mesh)[CHANGE_POSE]["pid"] not in (0, old), 60, "change_pose is back", every=CLI)
    assert run(mesh, ONE_MOVE)["outcome"] == "success"


@contextmanager
def swinging(mesh: Mesh, node: Ros, task: str = "3") -> Iterator[Program]:
    """A client that runs the swings, or another task; inside, the machine is moving."""
    moving = threading.Event()
    received = node.subscribe(
        MachineState, "/zx200/rc/state", lambda state: state.moving and state.goal and moving.set(), latched=True
    )
    with running_tms("run", task, "--wait", "--json", env=mesh.env) as client:
        try:
            if not moving.wait(60):
                pytest.fail(f"the machine does not move: {client.written()[0] or 'no answer from the run'}")
            yield client
        finally:
            node.node.destroy_subscription(received)


def newest(mesh: Mesh) -> str:
    rows = json.loads(mesh.tms("runs", "--limit", "1", "--json").stdout)
    return str(rows[0]["run_id"])


def stops(mesh: Mesh, run_id: str) -> list[str]:
    return [row["text"] for row in events(mesh, run_id) if row["kind"] == "stop"]


def test_cancel_ends_with_the_machine_standing(mesh: Mesh, node: Ros) -> None:
    with swinging(mesh, node) as client:
        run_id = newest(mesh)
        mesh.tms("cancel", run_id)
        out = client.output(30)
    assert json.loads(out)["outcome"] == "cancelled"
    assert client.returncode == 1
    seen = stops(mesh, run_id)
    assert seen and all(text.startswith("zx200 stood after") for text in seen)
    assert run(mesh, ONE_MOVE)["outcome"] == "success"


def test_a_subtask_killed_during_its_goal_comes_back_and_the_run_goes_on(mesh: Mesh, node: Ros) -> None:
    run(mesh, ONE_MOVE)  # so that the subtask runs and its pid is known
    pid = processes(mesh)[CHANGE_POSE]["pid"]
    with swinging(mesh, node, FEW_SWINGS) as client:
        os.kill(pid, signal.SIGKILL)
        out = client.output(150)
    answer = json.loads(out)
    assert answer["outcome"] == "success"
    seen = stops(mesh, answer["run_id"])
    assert seen and all(text.startswith("zx200 stood after") for text in seen)
    assert any(row["kind"] == "loss" and "sent again" in row["text"] for row in events(mesh, answer["run_id"]))


def test_a_killed_scheduler_comes_back_and_closes_its_run(mesh: Mesh, node: Ros) -> None:
    with swinging(mesh, node) as client:
        run_id = newest(mesh)
        os.kill(processes(mesh)["tms:ts"]["pid"], signal.SIGKILL)
        client.wait(30)
    assert client.returncode == 1

    def state() -> str:
        rows = json.loads(mesh.tms("runs", "--json").stdout)
        return str(next(row["state"] for row in rows if row["run_id"] == run_id))

    wait_until(lambda: state() == "interrupted", 60, "the run is closed")
    mesh.tms("rearm", "zx200", "--yes")  # the loss of the scheduler latches until a person has looked
    mesh.tms("param", "set", "zx200/swing_left", "swing_joint=1.5")  # static records are free again
    assert run(mesh, ONE_MOVE)["outcome"] == "success"


def test_up_twice_is_harmless(mesh: Mesh) -> None:
    before = {name: row["pid"] for name, row in processes(mesh).items()}
    assert "already runs" in mesh.tms("up").stderr
    assert {name: row["pid"] for name, row in processes(mesh).items()} == before


def test_restart_gives_a_new_process_of_the_same_name(mesh: Mesh) -> None:
    old = processes(mesh)["zx200:rp"]["pid"]
    mesh.tms("restart", "zx200:rp")
    new = processes(mesh)["zx200:rp"]
    assert new["pid"] != old and new["state"] == "RUNNING"
    mesh.wait_ready()


def test_every_process_ends_within_two_seconds_of_sigterm(mesh: Mesh) -> None:
    process = psutil.Process(processes(mesh)["zx200:rc"]["pid"])
    with Lateness().watched() as late:
        begun = time.monotonic()
        process.terminate()
        process.wait(20)
        passed = time.monotonic() - begun
    assert passed < 2.5 + late.most
    mesh.wait_ready()


def test_processes_are_forks_of_supervisord_that_show_their_names(mesh: Mesh) -> None:
    """Executed ones would cost twice the memory and start-up time (figures: `make bench ONLY=process`)."""
    daemon = int((mesh.state / "supervisord.pid").read_text())
    names = {" ".join(child.cmdline()).partition(" -m ")[2].strip() for child in psutil.Process(daemon).children()}
    assert {"tms_runtime.run zx200:rc", "tms_runtime.run tms:ts"} <= names
