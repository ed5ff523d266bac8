"""The journal against a database that refuses: what waits, what is dropped, and that nobody else pays for it."""

import os
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
import structlog
from tms_msg_db.msg import Event, Run
from tms_msg_db.srv import WriteJournal

from slow_disk import slow_disk
from tms_reason.errors import RosError
from tms_reason.reason import Foreign
from tms_ts import journal
from tms_ts.group_commit import SPARE, GroupCommit
from tms_ts.journal import LOST, Journal
from tms_ts.reasons import HistoryLost
from words import words


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
            raise RosError(Foreign("no answer"), code)
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
def kept(db: FakeDb, disk: GroupCommit, tmp_path: Path) -> Iterator[Journal]:
    with keeping(db, disk, tmp_path) as made:
        yield made


@contextmanager
def keeping(db: FakeDb, disk: GroupCommit, folder: Path) -> Iterator[Journal]:
    made = Journal(db, structlog.stdlib.get_logger("journal"), disk, folder)  # type: ignore[arg-type]
    yield made
    db.bad, db.trouble = {}, ""
    assert disk.wait(10)
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


def test_the_database_gets_an_entry_when_it_is_on_the_disk_and_who_puts_it_does_not_wait(
    db: FakeDb, disk: GroupCommit, tmp_path: Path
) -> None:
    with slow_disk(tmp_path) as slow, keeping(db, disk, slow.folder) as journal:
        put(journal, range(1, 2))
        db.wait(1)
        with slow.stalled():
            put(journal, range(2, 50))
            assert not disk.wait(0.3)
            assert db.stored == [1]
        db.wait(*range(1, 50))


def test_what_memory_cannot_hold_while_the_disk_is_full_is_counted_and_named(
    db: FakeDb, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    full = threading.Event()
    full.set()
    write = os.write

    def refuses(file: int, data: bytes) -> int:
        if full.is_set():
            raise OSError(28, "No space left on device")
        return write(file, data)

    monkeypatch.setattr("tms_runtime.durable.os.write", refuses)
    disk, before = GroupCommit(structlog.stdlib.get_logger("disk"), SPARE + 10_000), lost()
    with keeping(db, disk, tmp_path) as journal:
        put(journal, range(1, 9), "x" * 1500)  # more than the room, but for what is vital
        journal.put(Event(run_id="r", number=9, kind="stop", text="zx200 stood"))
        while not disk.trouble():
            assert not disk.wait(0.01)
        alarms = journal.alarms()
        assert "memory only: [Errno 28] No space left on device" in words(alarms[0])
        assert alarms[1] == HistoryLost("r", 4, 5, 8)
        assert lost() == before + 4 and db.stored == []
        assert journal.alarms() == []  # told
        full.clear()
        db.wait(1, 2, 3, 4, 9)
        assert disk.wait(10) and journal.alarms() == []
    disk.close(10)
