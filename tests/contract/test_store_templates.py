"""Templates are stored under their names, in documents that the C++ system reads, and only in their form."""

from typing import Any

import pytest

from tms_db import store
from tms_db.templates import Templates
from tms_reason.errors import DbError, TaskError, TmsError

TEXT = """<root main_tree_to_execute="BehaviorTree">
  <BehaviorTree ID="BehaviorTree"><Action ID="X" model_name="zx200" record_name="$r$"/></BehaviorTree>
</root>"""
OTHER = TEXT.replace("$r$", "$s$")
COMPACT = TEXT.replace("\n", "").replace("  ", "")


def theirs(db: store.Db, name: str, text: str, **more: Any) -> None:
    """A document of the C++ system."""
    db["subtask"].insert_one({"task_name": name, "type": "subtask", "task_sequence": text, **more})


def test_a_template_is_stored_as_the_cpp_system_does(db: store.Db) -> None:
    added = Templates(db).add("Dig", TEXT)
    assert (added.model_name, added.already_stored, added.replaced) == ("zx200", False, False)
    (document,) = db["subtask"].find({})
    assert {key: document[key] for key in ("task_name", "type", "model_name", "description")} == {
        "task_name": "Dig", "type": "subtask", "model_name": "zx200", "description": "Dig.xml",
    }  # fmt: skip
    assert document["task_sequence"] == Templates(db).get("Dig").task_sequence == TEXT
    assert "task_id" not in document


def test_the_same_text_is_stored_once_and_another_one_only_on_demand(db: store.Db) -> None:
    templates = Templates(db)
    templates.add("Dig", TEXT)
    assert templates.add("Dig", TEXT.replace("  ", "      ")).already_stored
    with pytest.raises(DbError, match="stored with another text") as caught:
        templates.add("Dig", OTHER)
    assert caught.value.code == "TEMPLATE_EXISTS"
    assert templates.get("Dig").task_sequence == TEXT
    assert templates.add("Dig", OTHER, replace=True).replaced
    assert templates.get("Dig").task_sequence == OTHER
    assert db["subtask"].count_documents({}) == 1


def test_list_and_removal(db: store.Db) -> None:
    templates = Templates(db)
    templates.add("b", TEXT, "second")
    templates.add("a", TEXT)
    assert [(one.name, one.description, one.task_sequence) for one in templates.all()] == [
        ("a", "a.xml", ""), ("b", "second", ""),
    ]  # fmt: skip
    templates.remove("a")
    for call in (lambda: templates.remove("a"), lambda: templates.get("a")):
        with pytest.raises(DbError, match="there is no template 'a'") as caught:
            call()
        assert caught.value.code == "TEMPLATE_MISSING"


def test_documents_of_the_cpp_system(db: store.Db) -> None:
    theirs(db, "Dig", OTHER, _id=2)
    theirs(db, "Dig", COMPACT, _id=1)
    db["subtask"].insert_one(
        {"_id": 3, "task_name": "Dig", "task_sequence": OTHER}
    )  # stored again after a change: it goes on reading the first
    store.prepare(db)
    templates = Templates(db)
    assert templates.get("Dig").task_sequence == COMPACT
    assert [one.name for one in templates.all()] == ["Dig"]
    assert templates.all()[0].added_at.year == 1970
    assert templates.add("Dig", TEXT).already_stored
    assert templates.add("Dig", OTHER, replace=True).replaced
    templates.remove("Dig")
    assert templates.all() == []


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("no", "line 1: not well-formed"),
        ("<tree/>", "<tree>, not <root>"),
        ("<root/>", "there is no <BehaviorTree>"),
        (TEXT.replace("</root>", '<BehaviorTree ID="B"/></root>'), "line 1: a template has exactly one <BehaviorTree>"),
        (TEXT.replace("</BehaviorTree>", "<X/></BehaviorTree>"), "line 2: the tree of a template has exactly one node"),
    ],
)
def test_what_is_no_template_is_refused(db: store.Db, text: str, says: str) -> None:
    with pytest.raises(TaskError, match=says) as caught:
        Templates(db).add("Dig", text)
    assert "\n" not in str(caught.value)
    assert Templates(db).all() == []


@pytest.mark.parametrize("name", ["", " ", "a\nb", " a", "x" * 201])
def test_a_name_that_no_call_can_write(db: store.Db, name: str) -> None:
    with pytest.raises(TmsError, match="template name"):
        Templates(db).add(name, TEXT)
    with pytest.raises(TmsError, match="description"):
        Templates(db).add("Dig", TEXT, "\x1b[2J")
