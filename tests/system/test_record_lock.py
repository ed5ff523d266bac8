"""A record that was planned with stays as it is until the machine has moved with it."""

import json
import time
from pathlib import Path

import pytest

from conftest import Mesh, wait_until

pytestmark = [pytest.mark.system, pytest.mark.timeout(200)]
LEAF = '<Action ID="LeafNodeZx200" model_name="zx200" record_name="lock_test" subtask_name="subtask_zx200_{}"/>'
TREE = '<root main_tree_to_execute="T"><BehaviorTree ID="T">{}</BehaviorTree></root>'


def record(mesh: Mesh) -> dict[str, object]:
    answer = json.loads(mesh.tms("param", "get", "zx200/lock_test", "--json").stdout)
    found: dict[str, object] = answer["values"]
    return found


def run(mesh: Mesh, folder: Path, subtask: str) -> str:
    (folder / "tree.xml").write_text(TREE.format(LEAF.format(subtask)))
    number = str(json.loads(mesh.tms("task", "add", str(folder / "tree.xml"), "--json").stdout)["task_id"])
    done = mesh.tms("run", number, "--wait", "--json", expect=None)
    mesh.tms("task", "rm", number)
    return str(json.loads(done.stdout)["outcome"])


def test_planning_locks_and_moving_frees(mesh: Mesh, tmp_path: Path) -> None:
    place = ["trajectory=1", "swing_joint=0.1", "boom_joint=-0.8", "arm_joint=1.9", "bucket_joint=0.8",
             "bucket_end_joint=0.0", "LOCK_FLG=false"]  # fmt: skip
    mesh.tms("param", "set", "zx200/lock_test", "--create", "--type", "dynamic", *place)
    assert run(mesh, tmp_path, "change_pose_plan") == "success"
    locked = record(mesh)
    assert locked["LOCK_FLG"] is True
    assert locked["LOCK_OWNER"] == "zx200:subtask_zx200_change_pose_plan"
    assert float(str(locked["LOCK_UNTIL"])) > time.time()
    assert run(mesh, tmp_path, "change_pose") == "success"
    wait_until(lambda: record(mesh)["LOCK_FLG"] is False, 30, "the lock is free")

    far = ["trajectory=0", "position_with_angle=1", "x=100.0", "y=0.0", "z=0.0", "theta_w=0.0"]
    mesh.tms("param", "set", "zx200/lock_test", *far)  # out of reach: the plan fails and frees it, too
    assert run(mesh, tmp_path, "change_pose_plan") == "failure"
    wait_until(lambda: record(mesh)["LOCK_FLG"] is False, 30, "the lock is free")
    mesh.tms("param", "rm", "zx200/lock_test")
