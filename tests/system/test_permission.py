"""The primitive wait_for_ur: a person answers by the command line, and the leaf goes on or fails."""

import json
from pathlib import Path

import pytest

from conftest import Mesh, wait_until

pytestmark = pytest.mark.system
TREE = (
    '<root main_tree_to_execute="T"><BehaviorTree ID="T"><Action ID="LeafNodeExcavator" model_name="zx200" '
    'primitive_name="primitive_wait_for_ur" target_record_name="next_step"/></BehaviorTree></root>'
)
LIMIT = 30.0  # s


@pytest.mark.parametrize(("word", "outcome"), [("yes", "success"), ("no", "failure")])
def test_the_answer_decides(mesh: Mesh, tmp_path: Path, word: str, outcome: str) -> None:
    (tmp_path / "tree.xml").write_text(TREE)
    number = str(json.loads(mesh.tms("task", "add", str(tmp_path / "tree.xml"), "--json").stdout)["task_id"])
    mesh.tms("run", number, "--ignore-warnings")
    wait_until(lambda: "next_step" in mesh.tms("answer", expect=None).stdout, LIMIT, "the question")
    mesh.tms("answer", word)
    wait_until(lambda: json.loads(mesh.tms("runs", "--json").stdout)[0]["state"] == outcome, LIMIT, outcome)
    mesh.tms("task", "rm", number)
