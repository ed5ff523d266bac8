"""Searches and changes of arrays as tms:db is asked for them, and what its answers mean to a node."""

import asyncio
from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_db.srv import ChangeArray, FindRecord

from tms_db.reasons import RecordMissing
from tms_machine.reasons import NoDatabase
from tms_machine.values import from_parameters
from tms_reason.wire import to_line
from tms_ts.flags import Flags


class Database:
    """Answers every call with one response, None for a database that is away."""

    def __init__(self, response: Any) -> None:
        self.response, self.asked, self.forgotten, self.woken = response, list[Any](), list[str](), 0
        ros: Any = SimpleNamespace(call_async=self.call_async, start=lambda begin: asyncio.run(begin()))
        records: Any = SimpleNamespace(forget=self.forgotten.append)
        self.flags = Flags(ros, records, self.wake, "r1")

    async def call_async(self, service: Any, name: str, request: Any, limit: float) -> Any:
        self.asked.append((name, request))
        return self.response

    def wake(self) -> None:
        self.woken += 1


@pytest.mark.parametrize("found", [True, False])
def test_a_search(found: bool) -> None:
    database = Database(FindRecord.Response(found=found))
    answer = database.flags.find({"CURRENT_SECTION": "370", "free": True, "n": 3})
    assert (answer.done, answer.error, answer.value, database.woken) == (True, None, found, 1)
    ((name, request),) = database.asked
    assert name == "/tms/db/find_record"
    assert from_parameters(request.values) == {"CURRENT_SECTION": "370", "free": True, "n": 3}


def test_a_change_of_an_array_ends_what_is_kept_of_its_record() -> None:
    database = Database(ChangeArray.Response())
    answer = database.flags.change_array("AREA", "blocks", "add", "block_1")
    assert (answer.done, answer.error, database.forgotten) == (True, None, ["AREA"])
    ((name, request),) = database.asked
    assert (name, request.record_name, request.model_name) == ("/tms/db/change_array", "AREA", "")
    assert (request.change, request.source) == ("add", "run r1")
    assert from_parameters([request.value]) == {"blocks": "block_1"}


@pytest.mark.parametrize(
    ("response", "code"),
    [
        (None, NoDatabase.code),
        (
            ChangeArray.Response(error_code="RECORD_MISSING", error_msg=to_line(RecordMissing("/AREA"))),
            "RECORD_MISSING",
        ),
    ],
)
def test_what_keeps_an_array_from_being_changed(response: Any, code: str) -> None:
    database = Database(response)
    answer = database.flags.change_array("AREA", "blocks", "reset", "")
    assert answer.done and answer.error is not None and answer.error.code == code
    assert database.forgotten == []
