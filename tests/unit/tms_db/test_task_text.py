"""Texts that are no task are refused in one line that says where; the stored form is stable."""

from pathlib import Path

import pytest

from tms_config.config import CONFIGS
from tms_db import task_text
from tms_reason.errors import TaskError

TREE = '<root main_tree_to_execute="A"><BehaviorTree ID="A"><AlwaysSuccess/></BehaviorTree></root>'
BOMB = '<!DOCTYPE r [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>' + TREE.replace("A", "&b;")


def refusal(text: str) -> str:
    with pytest.raises(TaskError) as caught:
        task_text.essence(text)
    assert caught.value.code == "BAD_TASK"
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "empty"),
        (" \n ", "empty"),
        ("hello", "line 1: not well-formed"),
        ("<root>\n\n<b></root>", "line 3: not well-formed"),
        ("<root>\0</root>", "line 1: the text contains a NUL byte"),
        ('<root a="1" a="2"/>', "Attribute a redefined"),
        ("<root>&foo;</root>", "Entity 'foo' not defined"),
        ("<!-- no end <!DOCTYPE a>", "Comment not terminated"),
        ("<tree/>", "<tree>, not <root>"),
        ("<root/>", "no <BehaviorTree>"),
        ("<root><BehaviorTree/></root>", "no <BehaviorTree>"),
        ("<root><TreeNodesModel/></root>", "no <BehaviorTree>"),
        ("\ud800", "no valid Unicode"),
        (BOMB, "line 1: a task must not have a DOCTYPE"),
        ("<?xml version='1.0'?>\n<!-- <a> -->\n" + BOMB, "line 3: a task must not have a DOCTYPE"),
        ('<!DOCTYPE r SYSTEM "file:///etc/passwd">' + TREE, "DOCTYPE"),
        ("\ufeff" + BOMB, "DOCTYPE"),
        ("<root>" + "<a>" * 10_000, "nested deeper than 200"),
        ("<root>" + "<a>" * 210 + "</a>" * 210 + "</root>", "nested deeper than 200"),
        (f"<root>{'x' * 5 * 2**20}</root>", "larger than 5000000 bytes"),
    ],
)
def test_what_is_no_task_is_refused(text: str, says: str) -> None:
    assert says in refusal(text)


def test_the_deepest_allowed_task_is_taken() -> None:
    inside = "<Sequence>" * 197 + "<AlwaysSuccess/>" + "</Sequence>" * 197
    text = TREE.replace("<AlwaysSuccess/>", inside)
    assert task_text.essence(text) == text


def test_layout_goes_and_newlines_in_attributes_stay() -> None:
    text = '<root>\n  <BehaviorTree ID="A">\n\t<Action ID="X" say="one&#10;two"/>\n  </BehaviorTree>\n</root>\n'
    assert task_text.essence(text) == (
        '<root><BehaviorTree ID="A"><Action ID="X" say="one&#10;two"/></BehaviorTree></root>'
    )


def test_layout_and_declaration_make_no_second_task() -> None:
    declared = '\ufeff<?xml version="1.0" encoding="Shift_JIS"?>\n' + TREE.replace("><", ">\n    <")
    assert task_text.essence(declared) == task_text.essence(TREE)


def test_doctype_in_a_comment_is_only_a_word() -> None:
    assert "<!DOCTYPE x>" in task_text.essence(TREE.replace("<AlwaysSuccess/>", "<!-- <!DOCTYPE x> --><A/>"))


def test_japanese_text_is_kept() -> None:
    assert "1つめの待機位置" in task_text.essence(TREE.replace("<AlwaysSuccess/>", '<A info="1つめの待機位置"/>'))


@pytest.mark.parametrize("path", sorted((CONFIGS / "tasks").glob("*.xml")), ids=lambda path: path.stem)
def test_every_sample_is_a_task_and_its_essence_is_stable(path: Path) -> None:
    essence = task_text.essence(task_text.read_file(path))
    assert task_text.essence(essence) == essence
    assert "\n" not in essence


@pytest.mark.parametrize(
    ("text", "models", "model"),
    [
        ("zx200 ic120 ic120", ("zx200", "ic120"), "ic120"),
        ("zx200 ic120", ("ic120", "zx200"), "zx200"),  # a tie: the first in the text
        ("ic120_1 ic120_1 ic120", ("ic120", "ic120_1"), "ic120_1"),
        ("LeafNodeZx200", ("zx200",), ""),
        ("zx200", (), ""),
    ],
)
def test_main_model(text: str, models: tuple[str, ...], model: str) -> None:
    assert task_text.main_model(text, models) == model


def test_file_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(TaskError, match=r"none\.xml: cannot be read \(No such file"):
        task_text.read_file(tmp_path / "none.xml")
    with pytest.raises(TaskError, match="cannot be read"):
        task_text.read_file(tmp_path)
    (tmp_path / "sjis.xml").write_bytes("待機".encode("shift_jis"))
    with pytest.raises(TaskError, match="is not UTF-8 text"):
        task_text.read_file(tmp_path / "sjis.xml")


def test_huge_file_is_refused_unread(tmp_path: Path) -> None:
    with (tmp_path / "huge.xml").open("wb") as file:
        file.truncate(100 * 2**20)
    with pytest.raises(TaskError, match=r"huge\.xml: is 100\.0 MB, larger than 5000000 bytes"):
        task_text.read_file(tmp_path / "huge.xml")
