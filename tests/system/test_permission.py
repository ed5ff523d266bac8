"""The primitive wait_for_ur: a person answers by the command line, and the leaf goes on or fails."""

import json
import os
import signal
from pathlib import Path

import pytest
from test_mesh import events, newest, processes
from test_stop import rearm

from conftest import CLI, Mesh, wait_until

pytestmark = pytest.mark.system
TREE = (
    '<root main_tree_to_execute="T"><BehaviorTree ID="T"><Action ID="LeafNodeExcavator" model_name="zx200" '
    'primitive_name="primitive_wait_for_ur" target_record_name="next_step"/></BehaviorTree></root>'
)
LIMIT = 30.0  # s


def ask(mesh: Mesh, folder: Path) -> str:
    """Start the task and wait for its question."""
    (folder / "tree.xml").write_text(TREE)
    number = str(json.loads(mesh.tms("task", "add", str(folder / "tree.xml"), "--json").stdout)["task_id"])
    mesh.tms("run", number, "--ignore-warnings")
    asked(mesh)
    return number


def asked(mesh: Mesh) -> None:
    wait_until(lambda: "next_step" in mesh.tms("answer", expect=None).stdout, LIMIT, "the question", every=CLI)


def state(mesh: Mesh) -> str:
    return str(json.loads(mesh.tms("runs", "--json").stdout)[0]["state"])


@pytest.mark.parametrize(("word", "outcome"), [("yes", "success"), ("no", "failure")])
def test_the_answer_decides(mesh: Mesh, tmp_path: Path, word: str, outcome: str) -> None:
    number = ask(mesh, tmp_path)
    mesh.tms("answer", word)
    wait_until(lambda: state(mesh) == outcome, LIMIT, outcome, every=CLI)
    mesh.tms("task", "rm", number)


def test_a_question_of_a_lost_scheduler_is_asked_by_the_next_one(mesh: Mesh, tmp_path: Path) -> None:
    number = ask(mesh, tmp_path)
    run = newest(mesh)
    os.kill(processes(mesh)["tms:ts"]["pid"], signal.SIGKILL)
    wait_until(lambda: state(mesh) == "interrupted", LIMIT, "the run is closed as interrupted", every=CLI)
    rearm(mesh)
    mesh.wait_ready()
    mesh.tms("resume", run, "--yes")
    asked(mesh)
    mesh.tms("answer", "yes")
    wait_until(lambda: state(mesh) == "success", LIMIT, "success", every=CLI)
    assert not [row["text"] for row in events(mesh, run) if row["kind"] == "again"], "the subtask was free"
    mesh.tms("task", "rm", number)
