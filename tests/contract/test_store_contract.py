"""What the repositories promise, on the in-memory store and on a real server of MongoDB's wire protocol."""

import queue
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import datetime, timedelta, timezone
from functools import partial
from itertools import count
from typing import Any

import pytest
import structlog
from pymongo.collection import Collection
from pymongo.errors import AutoReconnect

from stores import Server
from tms_config.clock import utc_now
from tms_db import freshness, store
from tms_db.arrays import changed
from tms_db.batches import Batches, Update
from tms_db.connection import StoreConnection
from tms_db.history import Event, History, Run
from tms_db.parameter_history import AT_ONCE, ParameterHistory
from tms_db.parameters import Parameters, RecordEdit
from tms_db.record_cache import Head
from tms_db.records import Record, Value, models_of
from tms_db.tasks import Tasks
from tms_reason.errors import DbError, TaskError, TmsError

BEGIN = datetime(2026, 1, 31, 6, 0, tzinfo=timezone.utc)


def tree(name: str = "a", model: str = "zx200") -> str:
    return f'<root>\n <BehaviorTree ID="{name}"><Action ID="X" model_name="{model}"/></BehaviorTree>\n</root>'


def code_of(call: Callable[[], Any]) -> str:
    with pytest.raises(DbError) as caught:
        call()
    assert "\n" not in str(caught.value)
    return caught.value.code


# tasks


def test_a_description_of_a_task_holds_no_control_characters(db: store.Db) -> None:
    with pytest.raises(TmsError, match=r"description '.*' holds the control character U\+001B"):
        Tasks(db).add(tree(), "dig\x1b[2J")
    assert Tasks(db).all() == []


def test_task_is_stored_as_the_paper_says(db: store.Db) -> None:
    added = Tasks(db).add(tree())
    document = db["task"].find_one({"task_id": added.task_id})
    assert document is not None
    assert (added.task_id, added.model_name, added.already_stored) == (1, "zx200", False)
    assert document["type"] == "task"
    assert document["model_name"] == "zx200"
    assert document["description"] == "No Commented."
    assert document["task_sequence"] == tree()
    task = Tasks(db).get(1)
    assert task.task_sequence == document["task_sequence"]
    assert abs(utc_now() - task.added_at) < timedelta(minutes=1)


def test_the_same_text_is_reported_not_stored_twice(db: store.Db) -> None:
    tasks = Tasks(db)
    tasks.add(tree("a"))
    again = tasks.add(tree("a").replace("\n", "\n\n  "), "another description")
    assert (again.task_id, again.already_stored) == (1, True)
    assert len(tasks.all()) == 1


def test_a_text_that_holds_another_one_is_a_new_task(db: store.Db) -> None:
    tasks = Tasks(db)
    tasks.add(tree())
    assert tasks.add(tree().replace("</root>", "<TreeNodesModel/></root>")).task_id == 2


def test_the_lowest_free_number_is_taken(db: store.Db) -> None:
    tasks = Tasks(db)
    assert [tasks.add(tree(name)).task_id for name in "abc"] == [1, 2, 3]
    tasks.remove(2)
    assert [tasks.add(tree(name)).task_id for name in "de"] == [2, 4]


def test_list_is_by_number_and_without_texts(db: store.Db) -> None:
    tasks = Tasks(db)
    tasks.add(tree("a"), "first")
    tasks.add(tree("b", "ic120"))
    assert [(t.task_id, t.model_name, t.description, t.task_sequence) for t in tasks.all()] == [
        (1, "zx200", "first", ""),
        (2, "ic120", "No Commented.", ""),
    ]


def test_missing_task(db: store.Db) -> None:
    assert code_of(lambda: Tasks(db).get(7)) == "TASK_MISSING"
    assert code_of(lambda: Tasks(db).remove(7)) == "TASK_MISSING"


def test_bad_task_leaves_nothing(db: store.Db) -> None:
    with pytest.raises(TaskError):
        Tasks(db).add("<root/>")
    assert Tasks(db).all() == []


def test_tasks_of_the_cpp_system_stay_and_count(db: store.Db) -> None:
    text = '<root><BehaviorTree ID="old"><AlwaysSuccess/></BehaviorTree></root>'
    for number in (1, 2):
        db["task"].insert_one({"task_id": number, "type": "task", "task_sequence": text.replace("old", f"old{number}")})
    tasks = Tasks(db)
    assert tasks.add(text.replace("old", "old2")).task_id == 2
    assert tasks.add(text).task_id == 3
    assert tasks.get(1).description == ""


def test_concurrent_registration_gives_each_text_one_number(server: Server, shared_db: store.Db) -> None:
    gate = threading.Barrier(8)

    def register(worker: int) -> list[int]:
        own = store.connect(server.uri, shared_db.name)  # as a process of its own would
        tasks = Tasks(own)
        gate.wait(10)
        numbers = [tasks.add(tree(f"own{worker}_{i}")).task_id for i in range(5)] + [tasks.add(tree("shared")).task_id]
        own.client.close()
        return numbers

    with ThreadPoolExecutor(8) as pool:
        numbers = list(pool.map(register, range(8)))
    assert len({worker[-1] for worker in numbers}) == 1
    assert sorted({number for worker in numbers for number in worker}) == list(range(1, 42))
    assert [task.task_id for task in Tasks(shared_db).all()] == list(range(1, 42))


def test_texts_that_come_at_the_same_time_are_stored_together(shared_db: store.Db) -> None:
    tasks, gate = Tasks(shared_db), threading.Barrier(16)

    def register(worker: int) -> tuple[int, int]:
        gate.wait(10)
        return tasks.add(tree(f"own{worker}")).task_id, tasks.add(tree("shared")).task_id

    with ThreadPoolExecutor(16) as pool:
        numbers = list(pool.map(register, range(16)))
    assert len({shared for _, shared in numbers}) == 1
    assert sorted({number for pair in numbers for number in pair}) == list(range(1, 18))


def test_a_store_that_is_away_is_told_to_everyone_who_waits(own_server: Server) -> None:
    db = own_server.open()
    tasks = Tasks(db)
    own_server.end(kill=True)
    with ThreadPoolExecutor(4) as pool:
        codes = list(pool.map(lambda number: code_of(lambda: tasks.add(tree(f"t{number}"))), range(4)))
    assert codes == ["STORE_DOWN"] * 4
    db.client.close()


def test_a_text_that_another_process_stores_meanwhile_is_found(db: store.Db, monkeypatch: pytest.MonkeyPatch) -> None:
    tasks, other = Tasks(db), Tasks(db)

    def late(_: int) -> list[int]:  # the other one is done between our look at the texts and our choice of a number
        monkeypatch.undo()
        assert other.add(tree()).task_id == 1
        return [2]

    monkeypatch.setattr(tasks._numbers, "lowest_free", late)
    added = tasks.add(tree())
    assert (added.task_id, added.already_stored) == (1, True)
    assert len(tasks.all()) == 1


# parameters


def test_types_come_back_as_they_went_in(db: store.Db) -> None:
    values: dict[str, Value] = {
        "i": 1,
        "d": 1.0,
        "big": 2**40,
        "b": True,
        "s": "4",
        "di": [1.0, 2.0],
        "ii": [1, 2],
        "bb": [True, False],
    }
    parameters = Parameters(db)
    assert parameters.set("zx200", "p", RecordEdit(values, "static", "text", "test"), create=True)
    document = parameters.get("zx200", "p")
    kinds = {name: (type(document[name]).__name__, document[name]) for name in values}
    expected = {name: (type(value).__name__, value) for name, value in values.items()}
    assert {**kinds, "big": 2**40} == {**expected, "big": 2**40}
    assert isinstance(document["big"], int)
    assert all(isinstance(part, float) for part in document["di"])
    assert (document["type"], document["description"], document["source"]) == ("static", "text", "test")


def test_only_the_given_fields_change(db: store.Db) -> None:
    parameters = Parameters(db)
    parameters.set("zx200", "p", RecordEdit({"x": 1.0, "y": 2.0}, "dynamic", "d"), create=True)
    assert not parameters.set("zx200", "p", RecordEdit({"x": 3.0}, source="camera", remove=["gone"]), create=True)
    document = parameters.get("zx200", "p")
    assert (document["x"], document["y"], document["type"], document["description"]) == (3.0, 2.0, "dynamic", "d")
    assert document["source"] == "camera"
    parameters.set("zx200", "p", RecordEdit({}, remove=["y"]))
    assert "y" not in parameters.get("zx200", "p")


def test_writers_of_different_fields_lose_nothing(shared_db: store.Db) -> None:
    parameters, gate = Parameters(shared_db), threading.Barrier(8)

    def write(worker: int) -> None:
        gate.wait(10)
        for i in range(20):
            parameters.set("zx200", "p", RecordEdit({f"f{worker}": i, f"only{worker}_{i}": True}), create=True)

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(write, range(8)))
    document = parameters.get("zx200", "p")
    assert [document[f"f{worker}"] for worker in range(8)] == [19] * 8
    assert sum(name.startswith("only") for name in document) == 160
    assert len(parameters.all()) == 1


def test_missing_record(db: store.Db) -> None:
    parameters = Parameters(db)
    assert code_of(lambda: parameters.get("zx200", "p")) == "RECORD_MISSING"
    assert code_of(lambda: parameters.set("zx200", "p", RecordEdit({"x": 1}))) == "RECORD_MISSING"
    assert code_of(lambda: parameters.remove("zx200", "p")) == "RECORD_MISSING"
    assert parameters.all() == []


def test_shared_record_has_no_model_and_is_one(db: store.Db) -> None:
    parameters = Parameters(db)
    db["parameter"].insert_one({"record_name": "BOARD", "FLG": False})  # as the C++ system stores it
    assert not parameters.set("", "BOARD", RecordEdit({"FLG": True}), create=True)
    assert parameters.set("", "OTHER", RecordEdit({"N": 1}), create=True)
    assert parameters.set("zx200", "BOARD", RecordEdit({"FLG": 3}), create=True)
    assert parameters.get("", "BOARD")["FLG"] is True
    assert "model_name" not in parameters.get("", "OTHER")
    assert [d["record_name"] for d in parameters.all("zx200")] == ["BOARD"]
    assert len(parameters.all()) == 3
    parameters.remove("", "BOARD")
    assert parameters.get("zx200", "BOARD")["FLG"] == 3


def test_bad_changes_are_refused_and_nothing_is_written(db: store.Db) -> None:
    parameters = Parameters(db)
    parameters.set("zx200", "p", RecordEdit({"x": 1}), create=True)
    bad = [
        RecordEdit({"x": 2, "y": float("nan")}),
        RecordEdit({"x": 2, "type": "static"}),
        RecordEdit({"x": 2}, remove=["x"]),
        RecordEdit({"x": 2}, remove=["model_name"]),
        RecordEdit({"x": 2}, type="fixed"),
    ]
    for change in bad:
        assert code_of(partial(parameters.set, "zx200", "p", change)) == "BAD_RECORD"
    assert code_of(lambda: parameters.set("zx200", "", RecordEdit({"x": 1}), create=True)) == "BAD_RECORD"
    assert parameters.get("zx200", "p")["x"] == 1


def test_static_records_rest_while_a_run_names_them(db: store.Db) -> None:
    parameters, history = Parameters(db), History(db)
    for model, record, type_ in (
        ("zx200", "p", "static"), ("zx200", "q", "static"), ("zx200", "sensed", "dynamic"), ("ic120", "p", "static"),
        ("", "shared", "static"),
    ):  # fmt: skip
        parameters.set(model, record, RecordEdit({"x": 1}, type_), create=True)
    active = replace(run("r1"), records=("zx200/p", "zx200/sensed", "/shared", "ic120/*"))
    history.write([active], [])
    for model, record in (("zx200", "p"), ("", "shared"), ("ic120", "p")):
        assert code_of(lambda: parameters.set(model, record, RecordEdit({"x": 2}))) == "STATIC_RECORD"  # noqa: B023
    assert code_of(lambda: parameters.set("zx200", "p", RecordEdit({"x": 2}, "dynamic"))) == "STATIC_RECORD"
    assert code_of(lambda: parameters.remove("zx200", "p")) == "STATIC_RECORD"
    parameters.set("zx200", "sensed", RecordEdit({"x": 2}))
    parameters.set("zx200", "q", RecordEdit({"x": 2}))
    history.write([replace(active, ended_at=active.started_at)], [])
    parameters.set("zx200", "p", RecordEdit({"x": 2}))
    parameters.remove("zx200", "p")


def test_a_change_may_expect_what_is_there(db: store.Db) -> None:
    parameters = Parameters(db)
    parameters.set("", "ROAD", RecordEdit({"TAKEN": False, "BY": ""}, "dynamic"), create=True)
    parameters.set("", "ROAD", RecordEdit({"TAKEN": True, "BY": "ic120_1"}, expected={"TAKEN": False}))
    with pytest.raises(DbError, match="record /ROAD was not changed: TAKEN is True, not False") as caught:
        parameters.set("", "ROAD", RecordEdit({"BY": "ic120_2"}, expected={"TAKEN": False}))
    assert caught.value.code == "CONFLICT"
    assert parameters.get("", "ROAD")["BY"] == "ic120_1"
    edit = RecordEdit({"a": 1}, expected={"a": 0})
    assert code_of(lambda: parameters.set("", "X", edit, create=True)) == "RECORD_MISSING"


@pytest.mark.parametrize(
    ("before", "change", "value", "after"),
    [
        (["a"], "add", "b", ["a", "b"]), (["a"], "add", "a", ["a"]), (["a"], "push", "a", ["a", "a"]),
        (["a", "b", "a"], "remove", "a", ["b"]), (["a"], "reset", "", []), ([], "add", 1, [1]),
        (None, "push", 2.5, [2.5]), (None, "remove", "a", []),
    ],
)  # fmt: skip
def test_an_array_is_changed(db: store.Db, before: list[Any] | None, change: str, value: Any, after: list[Any]) -> None:
    parameters = Parameters(db)
    fields = {"x": 1} if before is None else {"x": 1, "blocks": before}
    parameters.set("", "AREA", RecordEdit(fields, "dynamic"), create=True)
    assert parameters.change_array(("", "AREA"), "blocks", changed(change, value), "test") == after
    assert (parameters.get("", "AREA")["blocks"], parameters.get("", "AREA")["x"]) == (after, 1)


def test_what_is_no_array_is_not_changed(db: store.Db) -> None:
    parameters = Parameters(db)
    parameters.set("", "AREA", RecordEdit({"x": 1, "blocks": ["a"]}, "dynamic"), create=True)
    push = partial(parameters.change_array, change=changed("push", 1), source="test")
    assert code_of(lambda: push(("", "AREA"), "x")) == "BAD_RECORD"
    assert code_of(lambda: push(("", "AREA"), "blocks")) == "BAD_RECORD"  # a number among texts
    assert code_of(lambda: push(("", "AREA"), "type")) == "BAD_RECORD"
    assert code_of(lambda: push(("", "none"), "blocks")) == "RECORD_MISSING"
    assert code_of(lambda: changed("insert", 1)) == "BAD_RECORD"
    assert code_of(lambda: changed("push", [1])) == "BAD_RECORD"
    assert parameters.get("", "AREA")["blocks"] == ["a"]


def test_writers_of_one_array_lose_nothing(shared_db: store.Db) -> None:
    parameters = Parameters(shared_db)
    parameters.set("", "AREA", RecordEdit({"x": 1}, "dynamic"), create=True)
    with ThreadPoolExecutor(4) as pool:
        for one in [pool.submit(parameters.change_array, ("", "AREA"), "n", changed("push", i), "") for i in range(12)]:
            one.result()
    assert sorted(parameters.get("", "AREA")["n"]) == list(range(12))


def test_records_are_searched_by_value(db: store.Db) -> None:
    parameters = Parameters(db)
    parameters.set("", "TRUCK", RecordEdit({"section": "12", "way": "up", "n": 3, "free": True}), create=True)
    parameters.set("zx200", "p", RecordEdit({"blocks": ["a", "b"]}), create=True)
    there: list[dict[str, Any]] = [{"section": "12"}, {"section": "12", "way": "up"}, {"n": 3}, {"n": 3.0},
                                   {"free": True}, {"blocks": "b"},
                                   {"record_name": "p", "model_name": "zx200"}]  # fmt: skip
    absent: list[dict[str, Any]] = [{"section": 12}, {"section": "12", "way": "down"}, {"section": "12", "blocks": "a"},
                                    {"none": "x"}]  # fmt: skip
    assert [parameters.holds(one) for one in there] == [True] * len(there)
    assert [parameters.holds(one) for one in absent] == [False] * len(absent)
    assert code_of(lambda: parameters.holds({"$where": "true"})) == "BAD_RECORD"
    assert code_of(lambda: parameters.holds({"": "true"})) == "BAD_RECORD"


def test_a_record_of_several_models_is_one(db: store.Db) -> None:
    parameters = Parameters(db)
    db["parameter"].insert_one({"model_name": ["truck_1", "truck_2"], "record_name": "road", "type": "dynamic", "n": 1})
    assert parameters.get("truck_1", "road")["n"] == 1
    parameters.set("truck_2", "road", RecordEdit({"n": 2}))
    assert parameters.get("truck_1", "road")["n"] == 2
    assert [models_of(document) for document in parameters.all("truck_2")] == [["truck_1", "truck_2"]]
    assert parameters.all("zx200") == []
    parameters.set("truck_2", "road", RecordEdit({"n": 3}, "static"))
    History(db).write([replace(run("r1"), records=("truck_1/road",))], [])
    assert code_of(lambda: parameters.set("truck_2", "road", RecordEdit({"n": 4}))) == "STATIC_RECORD"


@pytest.mark.turns
def test_eight_writers_that_swap_lose_no_update(shared_db: store.Db) -> None:
    parameters = Parameters(shared_db)
    parameters.set("", "COUNT", RecordEdit({"n": 0}, "dynamic"), create=True)

    def count() -> None:
        done = 0
        while done < 20:
            seen = parameters.get("", "COUNT")["n"]
            try:
                parameters.set("", "COUNT", RecordEdit({"n": seen + 1}, expected={"n": seen}))
            except DbError as error:
                assert error.code == "CONFLICT"
            else:
                done += 1

    with ThreadPoolExecutor(8) as pool:
        for one in [pool.submit(count) for _ in range(8)]:
            one.result()
    assert parameters.get("", "COUNT")["n"] == 160


def test_an_age_limit_is_stored_kept_and_taken_away(db: store.Db) -> None:
    parameters = Parameters(db)
    parameters.set("zx200", "p", RecordEdit({"x": 1}, "dynamic", max_age=2.0), create=True)
    parameters.set("zx200", "p", RecordEdit({"x": 2}))
    assert parameters.get("zx200", "p")["max_age"] == 2.0
    parameters.set("zx200", "p", RecordEdit({}, max_age=-1.0))
    assert parameters.get("zx200", "p")["max_age"] == 0.0
    assert code_of(lambda: parameters.set("zx200", "p", RecordEdit({}, "static", max_age=1.0))) == "BAD_RECORD"


def test_load_makes_changes_and_leaves_alone(db: store.Db) -> None:
    parameters = Parameters(db)
    first = Record("zx200", "a", "static", "d", {"x": 1, "l": [1.0, 2.0]})
    second = Record("zx200", "b", "dynamic", "", {"x": 1.0})
    assert parameters.load([first, second], "file").created == ["zx200/a", "zx200/b"]
    before = parameters.get("zx200", "a")["updated_at"]
    parameters.set("zx200", "b", RecordEdit({"sensed": 5}))
    as_double = Record("zx200", "b", "dynamic", "", {"x": 1})  # another type is another value
    done = parameters.load([first, as_double], "file")
    assert (done.unchanged, done.changed) == (["zx200/a"], ["zx200/b"])
    assert parameters.get("zx200", "a")["updated_at"] == before
    assert isinstance(parameters.get("zx200", "b")["x"], int)
    assert parameters.get("zx200", "b")["sensed"] == 5


def test_two_documents_with_one_key_are_named_at_the_start(db: store.Db) -> None:
    db["parameter"].drop()
    db["parameter"].insert_many([{"model_name": "zx200", "record_name": "pose"} for _ in range(2)])
    assert code_of(lambda: store.prepare(db)) == "STORE_CONFLICT"


# history


class Batched:
    """Batches of updates over a store, with what their callers were told."""

    def __init__(self, db: store.Db) -> None:
        log = structlog.stdlib.get_logger("test")
        self.connection = StoreConnection(db, "test", log)
        self.connection.start()
        deadline = time.monotonic() + 20
        while self.connection.unready() and time.monotonic() < deadline:
            time.sleep(0.01)
        self.parameters, self.batches = Parameters(db), Batches(db, self.connection, log)
        self.reported: queue.Queue[DbError | None] = queue.Queue()

    def put(self, name: str, hurry: bool = False, **fields: Value) -> None:
        update = Update(self.parameters.get("zx200", name)["_id"], fields, BEGIN, "test")
        self.batches.put({("zx200", name): update}, self.reported.put, hurry)


@pytest.fixture
def batched(shared_db: store.Db) -> Iterator[Batched]:
    found = Batched(shared_db)
    for name in ("a", "b"):
        found.parameters.set("zx200", name, RecordEdit({"x": 0, "y": 0}, "dynamic"), create=True)
    yield found
    found.batches.stop()
    found.connection.stop()


def test_updates_are_readable_at_once_and_stored_before_they_are_acknowledged(batched: Batched) -> None:
    batched.put("a", x=1)
    batched.put("a", x=2, y=5)
    batched.put("b", x=3)
    newest = batched.batches.newest(("zx200", "a"))
    assert (newest["x"], newest["y"], newest["source"]) == (2, 5, "test")
    assert batched.parameters.get("zx200", "a")["x"] == 0
    batched.batches.start()
    assert [batched.reported.get(timeout=20) for _ in range(3)] == [None, None, None]
    stored = batched.parameters.get("zx200", "a")
    assert (stored["x"], stored["y"], stored["updated_at"]) == (2, 5, BEGIN)
    assert batched.parameters.get("zx200", "b")["x"] == 3
    batched.put("a", x=4)
    batched.batches.settle(("zx200", "a"))
    assert batched.parameters.get("zx200", "a")["x"] == 4
    assert batched.batches.newest(("zx200", "a")) == {}


def test_updates_of_a_record_that_is_gone_are_noticed(batched: Batched) -> None:
    batched.put("a", hurry=True, x=1)
    batched.parameters.remove("zx200", "a")
    batched.batches.start()
    assert batched.reported.get(timeout=20) is None
    assert batched.batches.gone.is_set()


def test_callers_are_told_when_the_store_is_away(own_server: Server) -> None:
    batched = Batched(own_server.open("away"))
    batched.parameters.set("zx200", "a", RecordEdit({"x": 0}, "dynamic"), create=True)
    batched.put("a", hurry=True, x=1)
    own_server.end(kill=True)
    batched.batches.start()
    reported = batched.reported.get(timeout=30)
    assert reported is not None
    assert reported.code == "STORE_DOWN"
    assert batched.batches.newest(("zx200", "a")) == {}
    batched.batches.stop()
    batched.connection.stop()


def test_the_last_changes_of_a_record(shared_db: store.Db) -> None:
    batched = Batched(shared_db)
    past = ParameterHistory(shared_db, batched.connection, structlog.stdlib.get_logger("test"))
    for number in range(60):
        past.note(("zx200", "a"), BEGIN + timedelta(seconds=number), "cli", {"x": number})
    past.start()
    past.stop()  # writes what is there
    past.note(("zx200", "a"), BEGIN, "sp", {"x": 1, "y": 1}, often=True)
    past.note(("zx200", "a"), BEGIN + timedelta(seconds=90), "sp", {"x": 2}, often=True)
    newest, *older = past.changes(("zx200", "a"))
    assert (newest["source"], newest["values"]) == ("sp", {"x": 2, "y": 1})
    assert [change["values"]["x"] for change in older] == list(range(59, 10, -1))
    assert past.changes(("zx200", "none")) == []
    batched.connection.stop()


@pytest.mark.parametrize("done", [0, 1, 2])
def test_a_change_is_told_once_though_its_write_was_repeated(
    shared_db: store.Db, monkeypatch: pytest.MonkeyPatch, done: int
) -> None:
    batched = Batched(shared_db)
    past = ParameterHistory(shared_db, batched.connection, structlog.stdlib.get_logger("test"))
    write, keys = Collection.bulk_write, (("zx200", "a"), ("zx200", "b"))

    def lost(self: Collection[Any], steps: list[Any], **more: Any) -> None:
        if done:
            write(self, steps[:done], **more)
        raise AutoReconnect("the connection went before the answer came")

    stamp = BEGIN.replace(microsecond=123_456)  # finer than the store keeps it
    for key in keys:
        past.note(key, stamp, "cli", {"x": 1, "s": "a", "d": [1.5, 2.0]})
    with monkeypatch.context() as patch:
        patch.setattr(Collection, "bulk_write", lost)
        past._store_new(list(past._new))
    assert [len(past.changes(key)) for key in keys] == [1, 1]
    past.note(keys[0], stamp, "cli", {"x": 2})
    deadline = time.monotonic() + 20
    while past._new and time.monotonic() < deadline:  # the connection comes back by itself
        past._store_new(list(past._new))
        time.sleep(0.02)
    assert not past._new
    assert [[change["values"]["x"] for change in past.changes(key)] for key in keys] == [[2, 1], [1]]
    batched.connection.stop()


def test_a_change_is_told_once_though_others_were_stored_between_its_writes(
    shared_db: store.Db, monkeypatch: pytest.MonkeyPatch
) -> None:
    batched = Batched(shared_db)
    past = ParameterHistory(shared_db, batched.connection, structlog.stdlib.get_logger("test"))
    write, keys, lost = Collection.bulk_write, [("zx200", f"r{number}") for number in range(2 * AT_ONCE)], list[bool]()

    def losing(self: Collection[Any], steps: list[Any], **more: Any) -> Any:
        done = write(self, steps, **more)
        if not lost:
            lost.append(True)
            raise AutoReconnect("the connection went before the answer came")
        return done

    monkeypatch.setattr(Collection, "bulk_write", losing)
    for key in keys:
        past.note(key, BEGIN, "cli", {"x": 1})
    past._store_new(keys[:AT_ONCE])
    assert lost and set(keys[:AT_ONCE]) <= past._new.keys()
    deadline = time.monotonic() + 20
    while past._new and time.monotonic() < deadline:  # the connection comes back by itself
        past._store_new(keys[AT_ONCE:] if keys[-1] in past._new else keys)
        time.sleep(0.02)
    assert [len(past.changes(key)) for key in keys] == [1] * len(keys)
    batched.connection.stop()


@pytest.mark.parametrize(
    ("stored", "sent", "said"),
    [
        ({"x": 1.0}, {"X": 2}, {"x": 2.0}),
        ({"LOADED_FLG": False}, {"loaded_flg": True, "more": 1}, {"LOADED_FLG": True}),
        ({"x": [1.0]}, {"x": 2.0}, "m/r.x holds an array, not a number"),
        ({"x": True}, {"x": 1}, "m/r.x holds true/false, not a number"),
        ({"x": 1}, {"y": 1}, "has none of the fields y"),
    ],
)
def test_what_a_loose_update_changes(stored: dict[str, Value], sent: dict[str, Value], said: object) -> None:
    head = Head({"_id": 1, "record_name": "r", "type": "dynamic", **stored}, 0.0)
    if isinstance(said, str):
        with pytest.raises(DbError, match=said):
            head.fit("m/r", sent, loose=True)
    else:
        assert head.fit("m/r", sent, loose=True) == said


def test_stale_records_are_told_with_age_limit_and_source() -> None:
    document = {"model_name": "zx200", "record_name": "p", "type": "dynamic", "updated_at": BEGIN, "source": "sp zed"}
    now = BEGIN + timedelta(seconds=12.3)
    freshness.check(document, 0.0, now)
    freshness.check(document, 20.0, now)
    freshness.check({**document, "max_age": 2.0}, -1.0, now)
    freshness.check({**document, "type": "static"}, 2.0, now)
    said = r"record zx200/p is 12.3 s old, allowed are 2.0 s \(last from sp zed\)"
    for given, limit in ((document, 2.0), ({**document, "max_age": 2.0}, 0.0)):
        with pytest.raises(DbError, match=said):
            freshness.check(given, limit, now)
    with pytest.raises(DbError, match="its age is not known"):
        freshness.check({**document, "updated_at": None}, 2.0, now)


def run(run_id: str, ended: bool = False, minute: int = 0) -> Run:
    started = BEGIN + timedelta(minutes=minute)
    state = "SUCCESS" if ended else "RUNNING"
    over = started + timedelta(seconds=9) if ended else None
    return Run(run_id, 4, "text", state, "", ("zx200",), started, over, values={"a.b": 1.5, "n": 3})


def event(run_id: str, number: int) -> Event:
    values: dict[str, Value] = {"x.y": 1.5, "$n": 3, "flags": [True]}
    return Event(run_id, number, BEGIN + timedelta(milliseconds=number), "node", "1/2", f"event {number}", values)


def test_history_comes_back_as_it_was_written(db: store.Db) -> None:
    history = History(db)
    history.write([run("r1", ended=True)], [event("r1", n) for n in (1, 2, 3)])
    assert history.runs() == [run("r1", ended=True)]
    assert history.events("r1") == [event("r1", n) for n in (1, 2, 3)]


def test_writing_again_changes_nothing(db: store.Db) -> None:
    history = History(db)
    history.write([run("r1")], [event("r1", n) for n in (1, 2)])
    for _ in range(2):
        history.write([run("r1"), run("r1", ended=True)], [event("r1", n) for n in (2, 1, 3, 3, 4)])
    assert [e.number for e in history.events("r1")] == [1, 2, 3, 4]
    assert history.runs() == [run("r1", ended=True)]


def test_runs_are_listed_newest_first(db: store.Db) -> None:
    history = History(db)
    history.write([run(f"r{n}", minute=n) for n in (2, 1, 3)], [])
    assert [r.run_id for r in history.runs()] == ["r3", "r2", "r1"]
    assert [r.run_id for r in history.runs(limit=2)] == ["r3", "r2"]


def test_events_after_a_number(db: store.Db) -> None:
    history = History(db)
    history.write([run("r1"), run("r2")], [event(r, n) for r in ("r1", "r2") for n in range(1, 21)])
    assert [e.number for e in history.events("r1", after=5, limit=3)] == [6, 7, 8]
    assert history.events("r1", after=20) == []
    assert code_of(lambda: history.events("none")) == "RUN_MISSING"


def test_bad_journal_is_refused_whole(db: store.Db) -> None:
    history = History(db)
    assert code_of(lambda: history.write([run("r1")], [event("r1", 1), event("r1", 0)])) == "BAD_JOURNAL"
    assert code_of(lambda: history.write([run("")], [])) == "BAD_JOURNAL"
    with pytest.raises(DbError, match=r"^run_id 'r\\n1' holds the control character U\+000A; Write a plain name$"):
        history.write([run("r\n1")], [])
    assert history.runs() == []


@pytest.mark.parametrize("size", [16 * 2**20 + 100, 17 * 2**20, 50 * 2**20])
def test_an_entry_that_is_too_large_is_told_as_such(shared_db: store.Db, size: int) -> None:
    """By the store or by its driver, whichever looks first: who writes must not try again for ever."""
    history, text = History(shared_db), "x" * size
    assert code_of(lambda: history.write([], [event("r1", 1), replace(event("r1", 2), text=text)])) == "TOO_LARGE"
    assert code_of(lambda: history.write([replace(run("r1"), reason=text)], [])) == "TOO_LARGE"
    history.write([run("r1")], [event("r1", n) for n in (1, 3)])
    assert [e.number for e in history.events("r1")] == [1, 3]


def test_two_writers_of_one_journal_lose_nothing(shared_db: store.Db) -> None:
    history, gate = History(shared_db), threading.Barrier(4)

    def write(_: int) -> None:
        gate.wait(10)
        for first in range(1, 41, 4):
            history.write([run("r1")], [event("r1", n) for n in range(first, first + 4)])

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(write, range(4)))
    assert [e.number for e in history.events("r1")] == list(range(1, 41))


# the server dies


def test_everything_survives_a_restart(own_server: Server) -> None:
    db = own_server.open()
    Tasks(db).add(tree())
    Parameters(db).set("zx200", "p", RecordEdit({"x": 1.5}), create=True)
    History(db).write([run("r1")], [event("r1", 1)])
    own_server.end()
    assert code_of(lambda: Tasks(db).get(1)) == "STORE_DOWN"
    own_server.start()
    assert Tasks(db).get(1).model_name == "zx200"
    assert Parameters(db).get("zx200", "p")["x"] == 1.5
    assert History(db).events("r1") == [event("r1", 1)]
    assert Tasks(db).add(tree()).already_stored  # the unique indexes are there, too
    db.client.close()


def test_kill_loses_no_acknowledged_write(own_server: Server) -> None:
    db = own_server.open()
    acknowledged: list[int] = []
    enough = threading.Event()

    def write() -> None:
        history = History(db)
        for number in count(1):
            try:
                history.write([], [event("r1", number)])
            except DbError:
                return
            acknowledged.append(number)
            if number >= 300:
                enough.set()

    writer = threading.Thread(target=write)
    writer.start()
    assert enough.wait(30)
    own_server.end(kill=True)
    writer.join(20)
    assert not writer.is_alive()
    own_server.start()
    stored = {e.number for e in History(db).events("r1", limit=10_000)}
    assert set(acknowledged) <= stored
    db.client.close()


def test_a_stopped_server_is_reported_in_time(own_server: Server) -> None:
    db = own_server.open()
    own_server.end(kill=True)
    for _ in range(2):
        begin = time.monotonic()
        assert code_of(lambda: Parameters(db).get("zx200", "p")) == "STORE_DOWN"
        assert time.monotonic() - begin < 15  # the driver by itself would try for 30 s
    db.client.close()
