"""Nodes written against upstream's definitions only drive our planner and subtasks, and serve our trees."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from conftest import PROJECT, Mesh
from tms_config.config import load_site
from tms_runtime.environment import environment

pytestmark = pytest.mark.system
SCRIPT = str(PROJECT / "tests" / "data" / "upstream_client.py")
TREE = (
    '<root main_tree_to_execute="T"><BehaviorTree ID="T"><Action ID="LeafNodeZx200" model_name="zx200" '
    'record_name="a_record_of_theirs" subtask_name="{}"/></BehaviorTree></root>'
)
SUCCEEDED, ABORTED = "4", "6"


def their_environment(mesh: Mesh) -> dict[str, str]:
    """ROS settings of the mesh; our own code is not on their path."""
    ours = environment(load_site(str(mesh.site)))
    kept = {key: ours[key] for key in ours if key.startswith(("ROS_", "FASTRTPS_", "HOME"))}
    return {**{key: value for key, value in os.environ.items() if key != "PYTHONPATH"}, **kept}


def ask(mesh: Mesh, *words: str) -> list[str]:
    done = subprocess.run([sys.executable, SCRIPT, *words], env=their_environment(mesh), capture_output=True,
                          text=True, timeout=90, check=True, cwd="/")  # fmt: skip
    return done.stdout.split()


@contextmanager
def foreign_server(mesh: Mesh, subtask: str) -> Iterator["subprocess.Popen[str]"]:
    command = [sys.executable, SCRIPT, "serve", "zx200", subtask]
    with subprocess.Popen(command, env=their_environment(mesh), stdout=subprocess.PIPE, text=True, cwd="/") as server:
        assert server.stdout is not None and server.stdout.readline() == "ready\n"
        try:
            yield server
        finally:
            server.send_signal(signal.SIGKILL)


def test_their_subtask_drives_our_planner(mesh: Mesh) -> None:
    over = ["4.5630998611", "-0.0995519981", "3.8403999805", "3.0"]
    assert ask(mesh, "rp", "zx200", "tms_rp_zx200_change_pose", *over) == [SUCCEEDED, "1"]
    assert ask(mesh, "rp", "zx200", "tms_rp_zx200_change_pose_plan", *over) == [SUCCEEDED, "1"]
    far = ask(mesh, "rp", "zx200", "tms_rp_zx200_change_pose", "40", "0", "0", "1")
    assert far[0] == ABORTED and far[1] != "1"


def test_their_leaf_drives_our_subtask(mesh: Mesh) -> None:
    mesh.tms("start", "zx200:subtask_zx200_change_pose")
    assert ask(mesh, "leaf", "zx200", "subtask_zx200_change_pose", "initial_pose") == [SUCCEEDED, "True"]
    assert ask(mesh, "leaf", "zx200", "subtask_zx200_change_pose", "no_such_record") == ["rejected", "None"]


def test_their_server_serves_our_tree(mesh: Mesh, tmp_path: Path) -> None:
    file = tmp_path / "tree.xml"
    file.write_text(TREE.format("st_zx200_of_theirs"))
    number = str(json.loads(mesh.tms("task", "add", str(file), "--json").stdout)["task_id"])
    assert "offers no 'st_zx200_of_theirs'" in mesh.tms("run", number, "--wait", expect=1).stderr
    with foreign_server(mesh, "st_zx200_of_theirs") as server:
        done = mesh.tms("run", number, "--wait", "--json", "--ignore-warnings")
        assert json.loads(done.stdout)["outcome"] == "success"
        assert server.stdout is not None and server.stdout.readline() == "zx200 a_record_of_theirs\n"
    mesh.tms("task", "rm", number)
