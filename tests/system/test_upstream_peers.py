"""Nodes written against upstream's definitions only drive our planner and subtasks, and serve our trees."""

import json
from pathlib import Path

import pytest

from conftest import Mesh
from upstream_peers import ABORTED, SUCCEEDED, ask, foreign_server

pytestmark = [pytest.mark.turns, pytest.mark.system]
TREE = (
    '<root main_tree_to_execute="T"><BehaviorTree ID="T"><Action ID="LeafNodeZx200" model_name="zx200" '
    'record_name="a_record_of_theirs" subtask_name="{}"/></BehaviorTree></root>'
)


def test_their_subtask_drives_our_planner(mesh: Mesh) -> None:
    over = ["4.5630998611", "-0.0995519981", "3.8403999805", "3.0"]
    assert ask(mesh, "rp", "zx200", "tms_rp_zx200_change_pose", *over) == [SUCCEEDED, "1"]
    assert ask(mesh, "rp", "zx200", "tms_rp_zx200_change_pose_plan", *over) == [SUCCEEDED, "1"]
    far = ask(mesh, "rp", "zx200", "tms_rp_zx200_change_pose", "40", "0", "0", "1")
    assert far[0] == ABORTED and far[1] != "1"


def test_their_leaf_drives_our_subtask(mesh: Mesh) -> None:
    mesh.tms("start", "zx200:subtask_zx200_change_pose")
    assert ask(mesh, "leaf", "zx200", "subtask_zx200_change_pose", "initial_pose")[:2] == [SUCCEEDED, "True"]
    assert ask(mesh, "leaf", "zx200", "subtask_zx200_change_pose", "no_such_record") == ["rejected", "None"]


def test_their_leaf_in_a_form_that_the_site_does_not_declare_moves_nothing(mesh: Mesh) -> None:
    """DDS connects it, and its inputs would be lost."""
    mesh.tms("start", "zx200:subtask_zx200_change_pose")
    words = ask(mesh, "leaf", "zx200", "subtask_zx200_change_pose", "initial_pose", "read_direction=down", form="v6b")
    assert words[:3] == [ABORTED, "False", "FORM_CONTRADICTED"] and 'told="v6b"' in words


def test_their_server_serves_our_tree(mesh: Mesh, tmp_path: Path) -> None:
    file = tmp_path / "tree.xml"
    file.write_text(TREE.format("st_zx200_of_theirs"))
    number = str(json.loads(mesh.tms("task", "add", str(file), "--json").stdout)["task_id"])
    assert "offers no 'st_zx200_of_theirs'" in mesh.tms("run", number, "--wait", expect=1).stderr
    with foreign_server(mesh, "serve", "zx200", "st_zx200_of_theirs") as server:
        done = mesh.tms("run", number, "--wait", "--json", "--ignore-warnings")
        assert json.loads(done.stdout)["outcome"] == "success"
        assert server.stdout is not None and server.stdout.readline() == "zx200 a_record_of_theirs\n"
    mesh.tms("task", "rm", number)
