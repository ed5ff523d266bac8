"""The journal against a database that refuses: what waits, what is dropped, and that nobody else pays for it."""

import logging
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tms_msg_db.msg import Event, Run
from tms_msg_db.srv import WriteJournal

from tms_core.errors import RosError
from tms_ts import journal
from tms_ts.journal import LOST, Journal


class FakeDb:
    """Stands in for `Ros`: stores what it is sent, but for requests that hold a bad entry."""

    def __init__(self) -> None:
        self.bad: dict[int, str] = {}  # number of an event -> code
        self.trouble = ""  # code of everything
        self.stored: list[int] = []
        self.asked = threading.Semaphore(0)

    def call(self, _: Any, name: str, request: Any) -> Any:
        assert name == "/tms/db/write_journal"
        codes = [self.trouble, *(self.bad.get(event.number, "") for event in request.events)]
        code = next(filter(None, codes), "")
        self.asked.release()
        if code == "NO_ANSWER":
            raise RosError("no answer", code)
        if not code:
            self.stored += [event.number for event in request.events]
        return WriteJournal.Response(error_code=code, error_msg=code.lower())

    def wait(self, *numbers: int) -> None:
        deadline = time.monotonic() + 10
        while self.stored[-len(numbers) :] != list(numbers):
            assert time.monotonic() < deadline, self.stored
            time.sleep(0.005)


@pytest.fixture
def db(monkeypatch: pytest.MonkeyPatch) -> FakeDb:
    monkeypatch.setattr(journal, "RETRY", 0.005)
    monkeypatch.setattr(journal, "GATHER", 0.005)
    return FakeDb()


@pytest.fixture
def kept(db: FakeDb, tmp_path: Path) -> Iterator[Journal]:
    made = Journal(db, logging.getLogger("journal"), tmp_path)  # type: ignore[arg-type]
    yield made
    db.bad, db.trouble = {}, ""
    made.close()
    made._thread.join(10)


def put(kept: Journal, numbers: range, text: str = "") -> None:
    for number in numbers:
        kept.put(Event(run_id="r", number=number, text=text))


def lost() -> float:
    return LOST._value.get()


@pytest.mark.parametrize("code", ["BAD_JOURNAL", "TOO_LARGE", "INTERNAL"])
def test_an_entry_that_is_refused_for_good_is_dropped_and_the_others_are_written(
    db: FakeDb, kept: Journal, code: str, caplog: pytest.LogCaptureFixture
) -> None:
    before = lost()
    db.bad = {7: code, 30: code}
    put(kept, range(1, 50))
    db.wait(*(number for number in range(1, 50) if number not in db.bad))
    assert lost() == before + 2
    assert caplog.text.count("event=journal_lost run=r") == 2
    put(kept, range(50, 52))
    db.wait(50, 51)


@pytest.mark.parametrize("code", ["STORE_DOWN", "STORE_FULL", "STORE_REFUSED", "STORE_CONFLICT", "BUSY", "NO_ANSWER"])
def test_nothing_is_dropped_while_the_database_cannot(
    db: FakeDb, kept: Journal, code: str, caplog: pytest.LogCaptureFixture
) -> None:
    before = lost()
    db.trouble = code
    put(kept, range(1, 10))
    for _ in range(20):
        assert db.asked.acquire(timeout=10)
    assert caplog.text.count("event=journal_waits") == 1
    db.trouble = ""
    db.wait(*range(1, 10))
    assert lost() == before


def test_an_entry_longer_than_a_batch_is_written_and_blocks_nobody(db: FakeDb, kept: Journal) -> None:
    put(kept, range(1, 2), "x" * 2**20)
    put(kept, range(2, 3))
    db.wait(1, 2)


def test_an_entry_that_no_store_could_take_is_not_even_kept(db: FakeDb, kept: Journal, tmp_path: Path) -> None:
    before = lost()
    put(kept, range(1, 2), "x" * 17 * 2**20)
    assert lost() == before + 1
    kept.put(Run(run_id="r"))
    put(kept, range(2, 3))
    db.wait(2)
