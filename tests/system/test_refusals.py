"""Bad input against a running mesh: one clear line, exit code 1, nothing half-done."""

import json
from pathlib import Path

import httpx
import pytest

from conftest import Mesh
from tms_config.config import load_site

pytestmark = pytest.mark.system

LEAF = '<Action ID="LeafNodeZx200" model_name="{machine}" record_name="{record}" subtask_name="{subtask}"/>'


def tree(record: str, subtask: str = "subtask_zx200_change_pose", machine: str = "zx200") -> str:
    leaf = LEAF.format(record=record, subtask=subtask, machine=machine)
    return f'<root main_tree_to_execute="T"><BehaviorTree ID="T">{leaf}</BehaviorTree></root>'


def refusal(mesh: Mesh, *words: str) -> str:
    """The one line that the command ends with."""
    done = mesh.tms(*words, expect=1)
    assert "Traceback" not in done.stderr + done.stdout
    return done.stderr.strip().splitlines()[-1]


def run_tree(mesh: Mesh, tmp_path: Path, text: str) -> str:
    """Store a tree, run it, and return the line that says why it did not work."""
    file = tmp_path / "tree.xml"
    file.write_text(text)
    number = json.loads(mesh.tms("task", "add", str(file), "--json").stdout)["task_id"]
    try:
        return refusal(mesh, "run", str(number), "--wait")
    finally:
        mesh.tms("task", "rm", str(number))


def test_unknown_task(mesh: Mesh) -> None:
    assert "no task 4711" in refusal(mesh, "run", "4711", "--wait")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (tree("no_such_record"), "no record zx200/no_such_record"),
        (tree("initial_pose", subtask="st_zx200_fly"), "zx200 offers no 'st_zx200_fly'"),
        (tree("initial_pose", machine="zx999"), "no machine 'zx999'"),
    ],
)
def test_preflight_refuses(mesh: Mesh, tmp_path: Path, text: str, said: str) -> None:
    assert said in run_tree(mesh, tmp_path, text)


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        (["trajectory=1", "swing_joint=0.0"], "boom_joint"),
        (["position_with_angle=1", "x='far'", "y=0.0", "z=0.0", "theta_w=1.0"], "x: "),
        (["position_with_angle=1", "x=50.0", "y=0.0", "z=0.0", "theta_w=1.0"], "m too far"),
        (["trajectory=1", "swing_joint=0.0", "boom_joint=0.9", "arm_joint=2.0", "bucket_joint=0.0",
          "bucket_end_joint=0.0"], "boom_joint"),
    ],
)  # fmt: skip
def test_records_that_do_not_fit(mesh: Mesh, tmp_path: Path, fields: list[str], said: str) -> None:
    mesh.tms("param", "set", "zx200/bad", "--create", "--type", "static", *fields)
    try:
        assert said in run_tree(mesh, tmp_path, tree("bad"))
    finally:
        mesh.tms("param", "rm", "zx200/bad")


def test_motions_are_checked_on_demand(mesh: Mesh) -> None:
    """They take time; the editor checks without them while somebody draws."""
    fields = ["position_with_angle=1", "x=50.0", "y=0.0", "z=0.0", "theta_w=1.0"]
    mesh.tms("param", "set", "zx200/far", "--create", "--type", "static", *fields)
    address = f"http://127.0.0.1:{load_site(str(mesh.site)).file.ports.console}/api/tasks/check"
    try:
        whole = httpx.post(address, json={"xml": tree("far")}, timeout=60).json()
        quick = httpx.post(f"{address}?motions=false", json={"xml": tree("far")}, timeout=60).json()
    finally:
        mesh.tms("param", "rm", "zx200/far")
    (found,) = whole["errors"]
    assert "m too far" in found["reason"]["text"]["en"]
    assert quick["errors"] == []


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("<root", "line 1"),
        (tree("initial_pose").replace("LeafNodeZx200", "LeafNodeZx20"), "LeafNodeZx20"),
        (tree("initial_pose").replace("record_name", "record_nam"), "record_nam"),
    ],
)
def test_trees_that_cannot_be_loaded(mesh: Mesh, tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "tree.xml"
    file.write_text(text)
    done = mesh.tms("task", "check", str(file), expect=1)
    assert said in done.stdout
    assert "Traceback" not in done.stderr
