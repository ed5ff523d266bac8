"""Values keep their types on the way through ROS; what has no ROS type is named."""

from datetime import datetime, timezone
from typing import Any

import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue

from tms_db import messages
from tms_db.cpp_services import content
from tms_db.history import Event, Run
from tms_db.tasks import Task
from tms_db.values import from_parameters, from_time, to_parameters, to_time
from tms_reason.errors import DbError

NOON = datetime(2026, 1, 31, 12, 0, 0, 123000, tzinfo=timezone.utc)


def there_and_back(values: dict[str, Any]) -> dict[str, Any]:
    parameters, left_out = to_parameters(values)
    assert left_out == []
    return dict(from_parameters("r", parameters))


@pytest.mark.parametrize(
    ("value", "comes_back"),
    [
        (1, 1),
        (-(2**63), -(2**63)),
        (1.0, 1.0),
        (True, True),
        (False, False),
        ("", ""),
        ("待機", "待機"),
        ([1, 2], [1, 2]),
        ([1.5, 2.0], [1.5, 2.0]),
        ([1, 2.5], [1.0, 2.5]),
        ([True, False], [True, False]),
        (["a", "b"], ["a", "b"]),
        ([], []),
        ({"a": [{"b": 1.0}]}, {"a": [{"b": 1.0}]}),
    ],
)
def test_types_survive(value: Any, comes_back: Any) -> None:
    back = there_and_back({"v": value})["v"]
    assert back == comes_back
    assert type(back) is type(comes_back)
    if isinstance(back, list):
        assert [type(part) for part in back] == [type(part) for part in comes_back]


@pytest.mark.parametrize("value", [{"a": NOON}, b"x", NOON, None, [[1]], ["a", 1], [True, 1], [{}, 1]])
def test_what_cannot_travel_is_named(value: Any) -> None:
    parameters, left_out = to_parameters({"x": 1, "odd": value})
    assert [parameter.name for parameter in parameters] == ["x"]
    assert left_out == ["odd"]


@pytest.mark.parametrize("kind", [ParameterType.PARAMETER_NOT_SET, ParameterType.PARAMETER_BYTE_ARRAY, 77])
def test_values_without_a_type_are_refused(kind: int) -> None:
    with pytest.raises(DbError, match=r"^r\.x: no value, or bytes"):
        from_parameters("r", [Parameter(name="x", value=ParameterValue(type=kind))])


def test_a_field_twice_is_refused() -> None:
    with pytest.raises(DbError, match="field x is there twice"):
        from_parameters("r", [*to_parameters({"x": 1})[0], *to_parameters({"x": 2})[0]])


def test_record_message_has_metadata_apart_from_values() -> None:
    document = {
        "_id": 7, "model_name": "zx200", "record_name": "p", "type": "static", "description": "d",
        "source": "s", "updated_at": NOON, "timestamps": {"a": 1}, "x": 1.5, "odd": NOON,
    }  # fmt: skip
    message, left_out = messages.record(document)
    assert left_out == ["odd"]
    assert (message.model_name, message.record_name, message.type) == ("zx200", "p", "static")
    assert (message.description, message.source) == ("d", "s")
    assert from_time(message.updated_at) == NOON
    assert [parameter.name for parameter in message.values] == ["x"]


@pytest.mark.parametrize("document", [{}, {"record_name": None, "type": 3, "updated_at": "today"}])
def test_odd_documents_become_messages(document: dict[str, Any]) -> None:
    message, _ = messages.record(document)
    assert message.record_name == ""
    assert message.updated_at.sec == 0


def test_history_survives_the_way() -> None:
    for ended in (None, NOON):
        run = Run("r1", 4, "d", "RUNNING", "why", ("zx200", "ic120_1"), NOON, ended, values={"a.b": [1.5], "n": 3})
        assert messages.stored_run(messages.run(run)) == run
    event = Event("r1", 3, NOON, "node", "1/2", "text", {"type": "x", "a.b": [1.5]})
    assert messages.stored_event(messages.event(event)) == event


def test_task_message() -> None:
    message = messages.task(Task(3, "zx200", "d", "<root/>", NOON))
    assert (message.task_id, message.task_sequence) == (3, "<root/>")
    assert from_time(message.added_at) == NOON


def test_dates_beyond_the_message_do_not_break_it() -> None:
    assert to_time(datetime(2200, 1, 1, tzinfo=timezone.utc)).sec == 2**31 - 1
    assert to_time(datetime(1900, 1, 1, tzinfo=timezone.utc)).sec == 0


def test_what_the_cpp_reader_gets() -> None:
    document = {"_id": 1, "record_name": "P", "x": 1.5, "qw": [1], "FLG": True, "updated_at": NOON}
    assert content(document, "param") == {
        "x": 1.5, "y": [], "z": [], "qx": [], "qy": [], "qz": [], "qw": [1], "Release_Count": [],
    }  # fmt: skip
    assert content(document, "flg") == {"x": 1.5, "qw": [1], "FLG": True}
