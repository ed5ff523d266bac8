"""What an update of sensing says about its age, and records of several machines."""

import math
from datetime import timedelta
from types import SimpleNamespace as Message
from typing import Any

import mongomock
import pytest
from tms_msg_db.srv import ChangeArray, FindRecord, GetParameter, ListParameters

from tms_config.clock import utc_now
from tms_db.batches import Update
from tms_db.parameter_services import OLDEST, ParameterServices
from tms_db.parameters import Parameters, RecordEdit
from tms_db.record_cache import Head, Key, RecordCache
from tms_machine.values import from_parameters, to_parameters
from tms_reason.errors import DbError


def taken(age: float) -> timedelta:
    """How old the values of an update are that comes with this age."""
    services: Any = ParameterServices.__new__(ParameterServices)
    services._batches = Message(gone=Message(is_set=lambda: False))
    services._heads = Message(dynamic=lambda key: Head({"_id": 1, "type": "dynamic"}, math.inf))
    updates: dict[Key, Update] = {}
    wanted = Message(values=to_parameters({"x": 1.0}), loose=False, keep=[], age=age, expected=[], source="sp")
    services._take(updates, ("zx200", "p"), wanted)
    stamp = updates["zx200", "p"].updated_at
    assert stamp is not None
    return utc_now() - stamp


@pytest.mark.parametrize(
    ("age", "counts"),
    [(0.0, 0.0), (2.5, 2.5), (-5.0, 0.0), (1e12, OLDEST), (1e300, OLDEST), (math.inf, OLDEST), (math.nan, OLDEST)],
)
def test_any_age_is_taken(age: float, counts: float) -> None:
    assert taken(age).total_seconds() == pytest.approx(counts, abs=1.0)


class Stored:
    """The services on a store in memory; nothing waits to be stored."""

    def __init__(self, *documents: dict[str, Any]) -> None:
        db: Any = mongomock.MongoClient().db
        db["parameter"].insert_many(documents)
        self.changes: list[list[str]] = []
        self.noted: list[Any] = []
        self.services: Any = ParameterServices.__new__(ParameterServices)
        parameters, newest = Parameters(db), lambda _: {}
        self.services._app = Message(log=Message(warning=lambda *_, **__: None))
        self.services._parameters = parameters
        self.services._batches = Message(newest=newest, settle=lambda _: None)
        self.services._heads = RecordCache(parameters, newest, Message(), lambda: True)  # type: ignore[arg-type]
        self.services._past = Message(note=lambda *what: self.noted.append(what))
        self.services._changes = Message(publish=lambda message: self.changes.append(list(message.record_names)))

    def get(self, model: str, record: str) -> Any:
        response = GetParameter.Response()
        self.services.get(GetParameter.Request(model_name=model, record_name=record), response)
        return response.record


ROAD = {"model_name": ["truck_1", "truck_2"], "record_name": "road", "type": "dynamic", "n": 1}


def test_a_record_of_several_models_is_the_record_of_each() -> None:
    stored = Stored(ROAD, {"model_name": "zx200", "record_name": "p", "type": "static", "n": 2})
    for model in ("truck_1", "truck_2"):
        record = stored.get(model, "road")
        assert (record.model_name, from_parameters(record.values)) == (model, {"n": 1})
    with pytest.raises(DbError):
        stored.get("zx200", "road")
    for asked, names in (("", ["truck_1", "truck_2", "zx200"]), ("truck_2", ["truck_2"]), ("zx200", ["zx200"])):
        response = ListParameters.Response()
        stored.services.list(ListParameters.Request(model_name=asked), response)
        assert sorted(record.model_name for record in response.records) == names


def test_what_is_written_under_one_model_is_read_under_the_other() -> None:
    stored = Stored(ROAD)
    assert [from_parameters(stored.get(model, "road").values)["n"] for model in ("truck_1", "truck_2")] == [1, 1]
    stored.services._parameters.set("truck_1", "road", RecordEdit({"n": 5}))
    assert [from_parameters(stored.get(model, "road").values)["n"] for model in ("truck_1", "truck_2")] == [5, 5]


def test_an_array_is_changed_noted_and_told() -> None:
    stored = Stored({"record_name": "AREA", "type": "dynamic", "blocks": ["a"]})
    (value,) = to_parameters({"blocks": "b"})
    asked = ChangeArray.Request(record_name="AREA", change="push", value=value, source="run 1")
    stored.services.change_array(asked, ChangeArray.Response())
    assert from_parameters(stored.get("", "AREA").values) == {"blocks": ["a", "b"]}
    assert stored.changes == [["AREA"]]
    assert [(key, source, fields) for key, _, source, fields in stored.noted] == [
        (("", "AREA"), "run 1", {"blocks": ["a", "b"]})
    ]


@pytest.mark.parametrize(("values", "found"), [({"n": 1}, True), ({"n": 1, "m": 2}, False)])
def test_records_are_searched(values: dict[str, Any], found: bool) -> None:
    response = FindRecord.Response()
    Stored(ROAD).services.find(FindRecord.Request(values=to_parameters(values)), response)
    assert response.found is found


def test_searches_and_arrays_are_offered() -> None:
    services, offered = Stored(ROAD).services, dict[str, tuple[str, Any]]()
    thread = Message(start=lambda: None, stop=lambda: None)
    services._batches, services._past, services._watching = thread, thread, thread
    services._app = Message(on_stop=lambda _: None)

    def serve(how: str) -> Any:
        return lambda kind, name, _: offered.update({name: (how, kind)})

    services.offer(Message(quick=serve("quick"), slow=serve("slow"), later=serve("later")))
    assert offered["change_array"] == ("quick", ChangeArray)
    assert offered["find_record"] == ("slow", FindRecord)  # it looks through all records
