"""An import takes over what a folder holds, all of it or nothing, and tells of each thing what becomes of it."""

import gzip
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bson
import pytest
from pymongo.errors import AutoReconnect

from tms_db import backup, import_plan, import_source, import_write, store
from tms_db.import_plan import NEW, OTHER, REFUSED, THERE, Plan
from tms_db.parameters import Parameters, RecordEdit
from tms_db.task_text import MODELS
from tms_db.tasks import Tasks
from tms_db.templates import Templates
from tms_reason.errors import DbError, TmsError
from words import words

TASK = '<root><BehaviorTree ID="{}"><LeafNodeZx200 record_name="a"/></BehaviorTree></root>'
CALLS = '<root><BehaviorTree ID="M"><Action ID="ExecuteSubtask" subtask_name="Dig"/></BehaviorTree></root>'
TEMPLATE = '<root><BehaviorTree ID="BehaviorTree"><LeafNodeZx200 record_name="{}"/></BehaviorTree></root>'
INITIAL = """
mongodb: {ip_address: localhost}
initial_parameters:
  - record_name: FLAGS
    values: {loaded: false, n: 3}
"""


@pytest.fixture
def put(tmp_path: Path) -> Callable[[str, str | bytes], Path]:
    def write(name: str, content: str | bytes) -> Path:
        path = tmp_path / "from" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return tmp_path / "from"

    return write


def planned(db: store.Db, folder: Path, **options: Any) -> Plan:
    return import_plan.plan(db, import_source.read(folder), MODELS, **options)


def told(plan: Plan) -> list[tuple[str, str, str, str]]:
    return [(item.kind, item.place, item.name, item.state) for item in plan.items]


def contents(db: store.Db) -> dict[str, list[dict[str, Any]]]:
    return {name: list(db[name].find({}, {"_id": 0})) for name in ("task", "subtask", "parameter")}


# what becomes what


def test_a_configuration_folder(db: store.Db, put: Any) -> None:
    put("demo/one.xml", TASK.format("one"))
    put("demo/calls.xml", CALLS)
    put("subtask/Excavator/Dig.xml", TEMPLATE.format("a"))  # called
    put("subtask/Excavator/Level.xml", TEMPLATE.format("$r$"))  # with a key
    put("palette.xml", "<root><TreeNodesModel/></root>")
    put("launch/initial_values.yaml", INITIAL)
    put("launch/params.yaml", "/**: {ros__parameters: {a: 1}}")
    put("launch/strange.yaml", "a: !env HOME")
    folder = put("README.md", "no")
    plan = planned(db, folder)
    assert told(plan) == [
        ("task", "demo/calls.xml", "1", NEW),
        ("task", "demo/one.xml", "2", NEW),
        ("template", "subtask/Excavator/Dig.xml", "Dig", NEW),
        ("template", "subtask/Excavator/Level.xml", "Level", NEW),
        ("record", "launch/initial_values.yaml, record 1", "/FLAGS", NEW),
        ("", "launch/params.yaml", "", OTHER),
        ("", "launch/strange.yaml", "", OTHER),
        ("", "palette.xml", "", OTHER),
    ]
    assert contents(db) == {"task": [], "subtask": [], "parameter": []}, "a plan writes nothing"
    import_write.write(db, plan)
    assert Tasks(db).get(2).task_sequence == TASK.format("one")
    assert Tasks(db).get(2).description == "demo/one.xml"
    assert Templates(db).get("Level").task_sequence == TEMPLATE.format("$r$")
    record = Parameters(db).get("", "FLAGS")
    assert (record["loaded"], record["n"], record["type"], record["source"]) == (False, 3, "dynamic", "import")


def test_the_same_import_again_changes_nothing(db: store.Db, put: Any) -> None:
    put("one.xml", TASK.format("one"))
    put("again.xml", TASK.format("one").replace("><", ">\n<"))
    put("Dig.xml", TEMPLATE.format("$r$"))
    put("copy/Dig.xml", TEMPLATE.format("$r$"))
    folder = put("initial_values.yaml", INITIAL)
    first = planned(db, folder)
    assert [item.state for item in first.items] == [NEW, NEW, THERE, THERE, NEW]
    import_write.write(db, first)
    before = contents(db)
    again = planned(db, folder)
    assert again.count(THERE) == len(again.items)
    import_write.write(db, again)
    assert contents(db) == before


def test_a_dump_keeps_its_documents_and_numbers(db: store.Db, put: Any) -> None:
    tasks = [{"_id": bson.ObjectId(), "task_id": 7, "type": "task", "task_sequence": TASK.format("seven"), "x": 1}]
    templates = [{"task_name": "Dig", "type": "subtask", "model_name": "zx200", "task_sequence": TEMPLATE.format("a")}]
    records = [
        {"model_name": "zx200", "record_name": "pose", "type": "static", "swing_joint": 0.5},
        {"model_name": ["mst110cr", "mst110cr_2"], "record_name": "goal", "type": "plan", "plan": {"points": [1]}},
    ]
    for name, documents in (("task", tasks), ("subtask", templates), ("parameter", records)):
        put(f"rostmsdb/{name}.bson", b"".join(map(bson.encode, documents)))
    put("rostmsdb/task.metadata.json", "{}")
    folder = put("rostmsdb/machine_pose.bson", b"")
    plan = planned(db, folder)
    assert [(kind, name, state) for kind, _, name, state in told(plan)] == [
        ("template", "Dig", NEW), ("task", "7", NEW), ("record", "zx200/pose", NEW),
        ("record", "mst110cr/goal, mst110cr_2/goal", NEW), ("", "", OTHER),
    ]  # fmt: skip
    assert [words(one) for one in plan.items[3].warnings] == [
        "one record for each of mst110cr, mst110cr_2",
        "type 'plan' counts as dynamic",
    ]
    import_write.write(db, plan)
    found = contents(db)
    assert found["task"] == [{key: value for key, value in tasks[0].items() if key != "_id"}]
    assert found["subtask"] == templates
    assert [record["model_name"] for record in found["parameter"]] == ["zx200", "mst110cr", "mst110cr_2"]
    assert found["parameter"][2]["plan"] == {"points": [1]}
    assert planned(db, folder).count(NEW) == 0


def test_a_number_that_is_taken_changes(db: store.Db, put: Any) -> None:
    Tasks(db).add(TASK.format("ours"))
    lines = [{"task_id": number, "task_sequence": TASK.format(f"t{number}")} for number in (1, 3)]
    plan = planned(db, put("rostmsdb.task.json", json.dumps(lines)))
    assert [(item.name, [words(one) for one in item.warnings]) for item in plan.items] == [
        ("2", ["task 1 becomes task 2, as there is another task 1"]), ("3", []),
    ]  # fmt: skip
    import_write.write(db, plan)
    assert [task.task_id for task in Tasks(db).all()] == [1, 2, 3]
    assert Tasks(db).add(TASK.format("t3")).task_id == 3


def test_a_packed_dump(db: store.Db, put: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    packed = gzip.compress(bson.encode({"task_id": 4.0, "task_sequence": TASK.format("four")}))
    put("rostmsdb/task.metadata.json.gz", gzip.compress(b"{}"))
    folder = put("rostmsdb/task.bson.gz", packed)
    assert told(planned(db, folder)) == [("task", "rostmsdb/task.bson.gz, document 1", "4", NEW)]
    for broken in (packed[:-9], packed[:20] + b"\0" * 20, b"no"):
        (item,) = planned(db, put("rostmsdb/task.bson.gz", broken)).items
        assert item.state == REFUSED and "cannot be read (" in words(item.why)
        assert "None" not in words(item.why)
    put("rostmsdb/task.bson.gz", packed)
    monkeypatch.setattr(import_source, "MAX_DUMP", 100)
    (item,) = planned(db, folder).items
    assert item.state == REFUSED and words(item.why).startswith("is larger than 0.0 MB")


def test_an_archive_of_mongodump(db: store.Db, shared_db: store.Db, put: Any, tmp_path: Path) -> None:
    Tasks(shared_db).add(TASK.format("one"))
    Templates(shared_db).add("Dig", TEMPLATE.format("$r$"))
    Parameters(shared_db).set("zx200", "pose", RecordEdit({"n": 1}, "static"), create=True)
    shared_db["run"].insert_one({"run_id": "r1"})
    shared_db["run"].insert_one({"run_id": "r2"})
    file = tmp_path / "site.archive"
    backup.backup(shared_db, file, lambda _: None)
    plan = planned(db, file)
    assert sorted((kind, name, state) for kind, _, name, state in told(plan)) == [
        ("", "", OTHER), ("record", "zx200/pose", NEW), ("task", "1", NEW), ("template", "Dig", NEW),
    ]  # fmt: skip
    import_write.write(db, plan)
    assert Tasks(db).get(1).task_sequence == TASK.format("one")
    with pytest.raises(DbError, match="no archive of mongodump"):
        import_source.read(put("a.txt", "no archive of anything") / "a.txt")


def test_exports_of_mongodb_are_lists_or_lines(db: store.Db, put: Any) -> None:
    one = {"_id": {"$oid": "0" * 24}, "record_name": "A", "n": {"$numberLong": "5"}, "type": "dynamic"}
    for text in (json.dumps([one]), f"{json.dumps(one)}\n"):
        (record,) = import_source.read(put("parameter.json", text)).records
        assert record.document == {"record_name": "A", "n": 5, "type": "dynamic"}


# what is refused


@pytest.mark.parametrize(
    ("name", "content", "why"),
    [
        ("a.xml", "<root>", "line 1: not well-formed XML"),
        ("a.xml", b"<root>\xff</root>", "is not UTF-8 text"),
        ("task.bson", b"\x05", "cannot be read ("),
        ("task.bson", bson.encode({"task_id": 1}), "the document has no task_sequence"),
        ("task.bson", bson.encode({"task_sequence": "<root/>"}), "there is no <BehaviorTree>"),
        ("task.json", "[{", "cannot be read ("),
        ("subtask.bson", bson.encode({"task_name": "a\nb", "task_sequence": TEMPLATE}), "template name"),
        ("subtask.bson", bson.encode({"task_name": "T", "task_sequence": "<root/>"}), "there is no <BehaviorTree>"),
        ("parameter.bson", bson.encode({"n": 1}), "record_name is empty"),
        ("r.yaml", "- {record_name: A, type: often}", "type is 'often': write static or dynamic"),
        ("r.yaml", "- {record_name: A, description: 5}", "description is 5, not text"),
        ("r.yaml", "- {record_name: A, type: static, max_age: 2.0}", "a static record cannot get too old"),
        ("Dig.xml", TEMPLATE.format("$r$").replace("</BehaviorTree>", "<X/></BehaviorTree>"), "exactly one node"),
    ],
)
def test_what_is_broken_is_refused(db: store.Db, put: Any, name: str, content: str | bytes, why: str) -> None:
    (item,) = planned(db, put(name, content)).items
    assert item.state == REFUSED
    assert item.why is not None and why in words(item.why)


def test_one_name_for_two_templates(db: store.Db, put: Any) -> None:
    put("a/Dig.xml", TEMPLATE.format("$r$"))
    plan = planned(db, put("b/Dig.xml", TEMPLATE.format("$s$")), replace=True)
    assert [item.state for item in plan.items] == [NEW, REFUSED]
    assert words(plan.items[1].why) == "there are two templates 'Dig' with different texts"


def test_what_is_there_with_another_content_is_replaced_only_on_demand(db: store.Db, put: Any) -> None:
    Templates(db).add("Dig", TEMPLATE.format("$old$"))
    Parameters(db).set("", "FLAGS", RecordEdit({"n": 4, "more": 1}, "dynamic"), create=True)
    put("Dig.xml", TEMPLATE.format("$new$"))
    folder = put("initial_values.yaml", INITIAL)
    plan = planned(db, folder)
    assert [words(item.why) for item in plan.items] == [
        "template 'Dig' is stored with another text",
        "record /FLAGS is there with other values: --replace takes these",
    ]
    plan = planned(db, folder, replace=True)
    assert [item.state for item in plan.items] == [NEW, NEW]
    import_write.write(db, plan)
    assert Templates(db).get("Dig").task_sequence == TEMPLATE.format("$new$")
    record = Parameters(db).get("", "FLAGS")
    assert (record["n"], record["loaded"], record["more"]) == (3, False, 1), "other fields stay"


def test_a_static_record_that_a_run_uses_is_not_replaced(db: store.Db, put: Any) -> None:
    Parameters(db).set("zx200", "pose", RecordEdit({"n": 1}, "static"), create=True)
    db["run"].insert_one({"run_id": "r1", "ended_at": None, "records": ["zx200/pose"]})
    new = bson.encode({"model_name": "zx200", "record_name": "pose", "type": "static", "n": 2})
    (item,) = planned(db, put("parameter.bson", new), replace=True).items
    assert item.state == REFUSED and "run r1 uses it" in words(item.why)


def test_a_folder_without_anything(tmp_path: Path, put: Any) -> None:
    for folder, says in ((tmp_path / "gone", "no such folder or file"), (put("a.txt", ""), "no trees and records")):
        with pytest.raises(TmsError, match=says):
            import_source.read(folder)


# all or nothing


@pytest.mark.parametrize("lost", ["insert", "replace"])
def test_a_store_that_is_lost_on_the_way_leaves_nothing(
    db: store.Db, put: Any, monkeypatch: pytest.MonkeyPatch, lost: str
) -> None:
    Templates(db).add("Dig", TEMPLATE.format("$old$"))
    Parameters(db).set("", "FLAGS", RecordEdit({"n": 4}, "dynamic"), create=True)
    put("one.xml", TASK.format("one"))
    put("Dig.xml", TEMPLATE.format("$new$"))
    put("Level.xml", TEMPLATE.format("$r$"))
    plan = planned(db, put("initial_values.yaml", INITIAL), replace=True)
    before = contents(db)
    kind, name = type(db["task"]), {"insert": "insert_many", "replace": "replace_one"}[lost]
    real, calls = getattr(kind, name), []

    def failing(self: Any, *args: Any, **more: Any) -> Any:
        calls.append(self)
        if len(calls) == 2:
            raise AutoReconnect("gone")
        return real(self, *args, **more)

    monkeypatch.setattr(kind, name, failing)
    with pytest.raises(DbError) as caught:
        import_write.write(db, plan)
    assert caught.value.code == "STORE_DOWN"
    assert len(calls) >= 2 and contents(db) == before


def test_what_cannot_be_taken_back_is_told(db: store.Db, put: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = planned(db, put("one.xml", TASK.format("one")))

    def gone(*_: Any, **__: Any) -> None:
        raise AutoReconnect("gone")

    for name in ("insert_many", "delete_many"):
        monkeypatch.setattr(type(db["task"]), name, gone)
    with pytest.raises(DbError, match="could not be taken back: import the same folder again"):
        import_write.write(db, plan)


def test_a_task_that_another_process_stores_meanwhile(db: store.Db, put: Any) -> None:
    plan = planned(db, put("one.xml", TASK.format("one")))
    Tasks(db).add(TASK.format("other"))
    with pytest.raises(DbError):
        import_write.write(db, plan)
    assert len(Tasks(db).all()) == 1
