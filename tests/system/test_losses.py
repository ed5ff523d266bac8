"""What deploy/FAILURES.md promises, on real processes; `make drill` tries it at every leaf and measures."""

import json
import os
import re
import signal
from contextlib import closing, suppress
from pathlib import Path

import psutil
import pytest
from test_mesh import CHANGE_POSE, FEW_SWINGS, ONE_MOVE, events, newest, processes, run, stops, swinging
from test_stop import rearm, state_of

from conftest import CLI, PROJECT, Mesh, wait_until
from tms_config.config import Site, load_site
from tms_host.supervisor import Supervisor
from tms_ros.node import Ros

pytestmark = [pytest.mark.turns, pytest.mark.system, pytest.mark.timeout(300)]


@pytest.mark.parametrize("name", ["zx200:rp", "zx200:rc"])
def test_a_run_goes_on_after_the_loss_of_planner_or_gateway(mesh: Mesh, node: Ros, name: str) -> None:
    mesh.wait_ready()
    old = processes(mesh)[name]["pid"]
    with swinging(mesh, node, FEW_SWINGS) as client:
        os.kill(old, signal.SIGKILL)
        out = client.output(150)
    answer = json.loads(out)
    assert answer["outcome"] == "success", answer
    seen = stops(mesh, answer["run_id"])
    assert seen and all(text.startswith("zx200 stood after") for text in seen)
    assert processes(mesh)[name]["pid"] not in (0, old)


EXECUTE = "primitive_excavator_change_pose_execute_from_plan"
ALONG_A_PLAN = '<root main_tree_to_execute="T"><BehaviorTree ID="T"><Sequence>{leaves}</Sequence></BehaviorTree></root>'
LEAF = (
    '<Action ID="LeafNodeExcavator" model_name="zx200" primitive_name="{name}" target_record_name="broken_off" '
    'previous_target_record_name=""/>'
)


def test_a_run_goes_on_along_its_stored_plan(mesh: Mesh, node: Ros, tmp_path: Path) -> None:
    run(mesh, ONE_MOVE)
    waypoint = {"type": "joint_values_relative", "data": {"swing_joint": 2.0, "boom_joint": 0.2}}
    record = {
        "model_name": "zx200", "record_name": "broken_off", "type": "dynamic", "description": "",
        "planning_group": "manipulator", "velocity_scale": 1.0, "acceleration_scale": 1.0, "waypoints": [waypoint],
    }  # fmt: skip
    (tmp_path / "records.yaml").write_text(json.dumps([record]))
    mesh.tms("param", "load", str(tmp_path / "records.yaml"))
    leaves = "".join(LEAF.format(name=name) for name in ("primitive_excavator_change_pose_plan", EXECUTE))
    (tmp_path / "tree.xml").write_text(ALONG_A_PLAN.format(leaves=leaves))
    task = str(json.loads(mesh.tms("task", "add", str(tmp_path / "tree.xml"), "--json").stdout)["task_id"])
    mesh.tms("start", f"zx200:{EXECUTE}")
    pid = processes(mesh)[f"zx200:{EXECUTE}"]["pid"]
    with swinging(mesh, node, task) as client:
        os.kill(pid, signal.SIGKILL)
        answer = json.loads(client.output(150))
    assert answer["outcome"] == "success", answer
    assert stops(mesh, answer["run_id"])
    mesh.tms("task", "rm", task)
    run(mesh, ONE_MOVE)


def test_a_run_does_not_need_the_store_and_its_history_comes_later(mesh: Mesh, node: Ros) -> None:
    run(mesh, ONE_MOVE)
    with swinging(mesh, node) as client:
        run_id = newest(mesh)
        known = len(events(mesh, run_id))
        mesh.tms("stop-process", "tms:store")
        spool = mesh.state / "ts" / "journal"
        wait_until(lambda: spool.stat().st_size > 0, 60, "events wait on disk")
        mesh.tms("start", "tms:store")
        out = client.output(150)
    assert json.loads(out)["outcome"] == "success"
    wait_until(lambda: spool.stat().st_size == 0, 60, "the events are delivered")
    rows = events(mesh, run_id)
    assert [row["number"] for row in rows] == list(range(1, len(rows) + 1))
    assert len(rows) > known and rows[-1]["text"] == "success"


def test_a_process_that_ends_again_and_again_fails_its_leaf_and_nothing_else(mesh: Mesh, node: Ros) -> None:
    run(mesh, ONE_MOVE)
    others = {name: row["pid"] for name, row in processes(mesh).items() if name != CHANGE_POSE}
    with swinging(mesh, node) as client:
        crash_until_fatal(mesh, CHANGE_POSE)
        out = client.output(150)
    answer = json.loads(out)
    assert answer["outcome"] == "failure"
    said = re.search(rf"process {CHANGE_POSE} is (FATAL|BACKOFF, for)", answer["error_msg"])
    assert said, answer["error_msg"]  # on a busy PC it is away for 10 s before supervisord has given it up
    alarms = [row["text"] for row in events(mesh, answer["run_id"]) if row["kind"] == "alarm"]
    assert said[1] != "FATAL" or any("FATAL" in text for text in alarms)
    assert CHANGE_POSE in mesh.tms("status", expect=1).stdout
    assert {name: row["pid"] for name, row in processes(mesh).items() if name != CHANGE_POSE} == others
    mesh.tms("restart", CHANGE_POSE)
    assert run(mesh, ONE_MOVE)["outcome"] == "success"


def crash_until_fatal(mesh: Mesh, name: str) -> None:
    """Kill a process as soon as it lives, as a bug at its start would."""
    with closing(Supervisor(load_site_of(mesh))) as supervisor:

        def fatal() -> bool:
            row = next(row for row in supervisor.processes() if row.name == name)
            if row.pid:
                with suppress(ProcessLookupError):
                    os.kill(row.pid, signal.SIGKILL)
            return row.state == "FATAL"

        wait_until(fatal, 90, f"{name} is given up")


def load_site_of(mesh: Mesh) -> Site:
    with pytest.MonkeyPatch.context() as patch:
        for key, value in mesh.env.items():
            patch.setenv(key, value)
        return load_site()


def test_a_stop_gets_through_to_a_tree_that_spins(mesh: Mesh, node: Ros) -> None:
    file = PROJECT / "tests" / "data" / "spin.xml"
    task = str(json.loads(mesh.tms("task", "add", str(file), "--json").stdout)["task_id"])
    run(mesh, ONE_MOVE)
    with swinging(mesh, node, task) as client:
        mesh.tms("stop")
        out = client.output(60)
    answer = json.loads(out)
    assert answer["outcome"] == "cancelled" and "software stop" in answer["error_msg"]
    rearm(mesh)
    mesh.tms("task", "rm", task)


def test_without_supervisord_everything_ends_and_the_run_can_be_given_up(mesh: Mesh, node: Ros) -> None:
    with swinging(mesh, node):
        pids = [row["pid"] for row in processes(mesh).values() if row["pid"]]
        run_id = newest(mesh)
        os.kill(int((mesh.state / "supervisord.pid").read_text()), signal.SIGKILL)
        wait_until(lambda: not any(map(psutil.pid_exists, pids)), 30, "the processes have ended")
    mesh.tms("up")
    mesh.wait_ready()
    wait_until(lambda: state_of(mesh, run_id) == "interrupted", 60, "the run is closed as interrupted", every=CLI)
    mesh.tms("abandon", run_id)
    if not Path(mesh.state, "rc", "zx200.armed").exists():
        rearm(mesh)
    assert run(mesh, ONE_MOVE)["outcome"] == "success"
