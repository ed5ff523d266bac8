"""Notes reach the disk, then the database: each once, in order, tied to the one before, whatever ends in between."""

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from rclpy.serialization import deserialize_message, serialize_message
from tms_msg_db.msg import Event
from tms_msg_db.srv import ListEvents, WriteJournal

from conftest import wait_until
from tms_reason.errors import RosError
from tms_reason.reason import Foreign
from tms_ur import audit
from tms_ur.audit_chain import ChainCheck, ChainHead, Note, tied
from tms_ur.audit_ledger import Ledger, reported


class FakeRos:
    """A database behind ROS: a number that is there already is left as it is; `away` is how often nobody answers."""

    def __init__(self) -> None:
        self.stored: dict[int, Event] = {}
        self.away = 0
        self.forgets_to_answer = False

    def call(self, service_type: Any, name: str, request: Any) -> Any:
        if self.away:
            self.away -= 1
            raise RosError(Foreign("nobody answers"))
        if service_type is ListEvents:
            found = [self.stored[number] for number in sorted(self.stored) if number > request.after]
            return ListEvents.Response(events=found[: request.limit], error_code="" if found else "RUN_MISSING")
        assert name == "/tms/db/write_journal"
        for event in deserialize_message(serialize_message(request), WriteJournal.Request).events:
            self.stored.setdefault(event.number, event)
        if self.forgets_to_answer:
            self.away = 10**6
            raise RosError(Foreign("nobody answers"))
        return WriteJournal.Response()

    def targets(self) -> list[str]:
        return [self.stored[number].node for number in sorted(self.stored)]

    def verdict(self) -> ChainCheck:
        verdict = ChainCheck()
        for number in sorted(self.stored):
            verdict.add(audit.of_event(self.stored[number]))
        return verdict


@pytest.fixture
def ros(monkeypatch: pytest.MonkeyPatch) -> FakeRos:
    monkeypatch.setattr(audit, "RETRY", 0.001)
    return FakeRos()


@pytest.fixture
def start(ros: FakeRos, tmp_path: Path) -> Iterator[Callable[[], audit.Audit]]:
    """Start the console's audit, as often as a test wants to."""
    made: list[audit.Audit] = []

    def again() -> audit.Audit:
        made.append(audit.Audit(ros, tmp_path / "audit.db"))  # type: ignore[arg-type]
        return made[-1]

    yield again
    for one in made:
        one.close()


def put(notes: audit.Audit, *targets: str) -> None:
    for target in targets:
        assert notes.put("mina", "192.0.2.1", "restart", target).wait(10)


def test_notes_wait_for_the_database(ros: FakeRos, start: Callable[[], audit.Audit]) -> None:
    ros.away = 3
    put(start(), "a", "b")
    wait_until(lambda: len(ros.stored) == 2, 10, "notes reach the database")
    assert (ros.targets(), sorted(ros.stored)) == (["a", "b"], [1, 2])
    assert ros.verdict().intact


def test_what_waits_survives_a_restart(ros: FakeRos, start: Callable[[], audit.Audit]) -> None:
    ros.away = 10**9
    first = start()
    put(first, "a", "b")
    first.close()
    assert ros.stored == {}
    ros.away = 0
    put(start(), "c")
    wait_until(lambda: len(ros.stored) == 3, 10, "notes reach the database")
    assert ros.targets() == ["a", "b", "c"]


def test_an_answer_that_got_lost_before_a_restart_stores_nothing_twice(
    ros: FakeRos, start: Callable[[], audit.Audit]
) -> None:
    first = start()
    put(first, "a")
    wait_until(lambda: first.number() == 1, 10, "notes are numbered")
    ros.forgets_to_answer = True
    put(first, "b")
    wait_until(lambda: len(ros.stored) == 2, 10, "notes reach the database")
    first.close()
    ros.forgets_to_answer, ros.away = False, 0
    put(start(), "c")
    wait_until(lambda: len(ros.stored) == 3, 10, "notes reach the database")
    assert ros.targets() == ["a", "b", "c"]
    assert ros.verdict().intact


@pytest.mark.parametrize("damage", [Path.unlink, lambda file: file.write_bytes(b"no database" * 1000)])
def test_a_lost_file_goes_on_behind_the_database(
    ros: FakeRos, start: Callable[[], audit.Audit], tmp_path: Path, damage: Callable[[Path], object]
) -> None:
    first = start()
    put(first, "a", "b")
    wait_until(lambda: first.number() == 2, 10, "notes are numbered")
    first.close()
    damage(tmp_path / "audit.db")
    put(start(), "c")
    wait_until(lambda: len(ros.stored) == 3, 10, "notes reach the database")
    assert (sorted(ros.stored), ros.targets()) == ([1, 2, 3], ["a", "b", "c"])
    assert ros.verdict().intact


def test_a_file_from_a_backup_takes_no_entry_for_a_duplicate(
    ros: FakeRos, start: Callable[[], audit.Audit], tmp_path: Path
) -> None:
    file = tmp_path / "audit.db"
    first = start()
    put(first, "a")
    wait_until(lambda: first.number() == 1, 10, "notes are numbered")
    first.close()
    old = file.read_bytes()
    second = start()
    put(second, "b", "c")
    wait_until(lambda: second.number() == 3, 10, "notes are numbered")
    second.close()
    file.write_bytes(old)
    put(start(), "d")
    wait_until(lambda: len(ros.stored) == 4, 10, "notes reach the database")
    assert ros.targets() == ["a", "b", "c", "d"]
    assert ros.verdict().intact


def test_entries_from_before_are_the_beginning(ros: FakeRos, start: Callable[[], audit.Audit]) -> None:
    now = int(time.time()) + 631  # they were numbered by the clock, or ahead of it
    ros.stored = {number: Event(run_id="audit", number=number, kind="stop", node="old") for number in (now - 9, now)}
    put(start(), "a", "b")
    wait_until(lambda: len(ros.stored) == 4, 10, "notes reach the database")
    assert sorted(ros.stored)[2:] == [now + 1, now + 2]
    verdict = ros.verdict()
    assert (verdict.older, verdict.chained, verdict.first, verdict.intact) == (2, 2, now + 1, True)


@pytest.mark.parametrize("target", ["half a character: \ud800", "a NUL\0behind it", "x" * 10**6])
def test_any_text_can_be_sent_and_stays_as_it_is(ros: FakeRos, start: Callable[[], audit.Audit], target: str) -> None:
    put(start(), target, "b")
    wait_until(lambda: len(ros.stored) == 2, 10, "notes reach the database")
    assert ros.verdict().intact
    assert len(ros.targets()[0]) <= audit.LONGEST


def test_put_waits_neither_for_disk_nor_database(
    ros: FakeRos, start: Callable[[], audit.Audit], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """A folder in the place of the file is a disk that fails; the log has every command."""
    (tmp_path / "audit.db").mkdir()
    notes = start()
    before = audit.LOST._value.get()
    kept = [notes.put("mina", "192.0.2.1", "stop", f"stop {number}") for number in range(audit.MAX_NEW + 50)]
    assert not any(one.is_set() for one in kept)
    assert audit.LOST._value.get() > before
    wait_until(lambda: "event=audit_disk_failed" in caplog.text, 10, "the failing disk is told")


def test_strangers_are_summed_up(ros: FakeRos, start: Callable[[], audit.Audit]) -> None:
    notes = start()
    for number in range(654):
        notes.refused(f"guess {number}", "192.0.2.9", "login_refused", "LOGIN")
    notes.refused("-", "192.0.2.9", "refused", "FOREIGN_ORIGIN")
    wait_until(lambda: len(ros.stored) == 2, 10, "notes reach the database")
    notes.close()
    again = start()  # what was counted meanwhile is on the disk
    wait_until(lambda: again.number() == 3, 10, "notes are numbered")
    rows = [(event.kind, event.node, event.text, audit.of_event(event).note.times) for event in ros.stored.values()]
    assert rows == [
        ("login_refused", "LOGIN", "guess 0 from 192.0.2.9", 1),
        ("refused", "FOREIGN_ORIGIN", "- from 192.0.2.9", 1),
        ("login_refused", "LOGIN", "guess 653 from 192.0.2.9", 653),
    ]


def test_the_disk_remembers_the_last_entry(tmp_path: Path) -> None:
    file = tmp_path / "audit.db"
    assert reported(file) is None
    ledger = Ledger(file)
    assert ledger.place() is None
    ledger.append([Note(1, "stop", "a", "mina"), Note(2, "stop", "b", "mina")])
    ids, notes = ledger.waiting(10)
    ledger.move(ChainHead(7, tied(ChainHead(6, ""), notes[:1])[0].hash), ids[0])
    ledger.close()
    assert reported(file) == ChainHead(7, tied(ChainHead(6, ""), notes[:1])[0].hash)
    assert Ledger(file).waiting(10)[1] == notes[1:]
    assert file.stat().st_mode & 0o777 == 0o600
