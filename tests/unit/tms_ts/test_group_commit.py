"""Who puts waits for nobody, and what is stored is on the disk: one that stalls, is full, or loses its power."""

import errno
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
import structlog

from power_cut import own_disk
from slow_disk import SMALL, slow_disk
from tms_ts import group_commit
from tms_ts.group_commit import SPARE, GroupCommit
from tms_ts.spool import Spool

LIMIT = 20.0  # s for what must happen at all
log = structlog.stdlib.get_logger("disk")


class Sink:
    """A file in memory whose disk may be slow or full."""

    def __init__(self, calls: list[str] | None = None, name: str = "", order: int = 0) -> None:
        self.order, self._name = order, name
        self.stored, self._group = list[bytes](), list[bytes]()
        self.calls = calls if calls is not None else []
        self.full = 0  # times that it refuses
        self.syncing, self.works = threading.Event(), threading.Event()
        self.works.set()

    def write(self, entries: list[bytes]) -> None:
        self._group = entries

    def sync(self) -> None:
        self.calls.append(self._name)
        self.syncing.set()
        assert self.works.wait(LIMIT)
        if self.full:
            self.full -= 1
            raise OSError(errno.ENOSPC, "No space left on device")

    def keep(self) -> None:
        self.stored += self._group


@pytest.fixture
def commit(monkeypatch: pytest.MonkeyPatch) -> Iterator[GroupCommit]:
    monkeypatch.setattr(group_commit, "RETRY", 0.005)
    made = GroupCommit(log, SPARE + 100)
    yield made
    made.close(LIMIT)


def test_on_a_disk_that_stalls_nobody_waits_and_nothing_counts_as_stored(tmp_path: Path, commit: GroupCommit) -> None:
    with slow_disk(tmp_path) as disk:
        news = threading.Event()
        spool = Spool(disk.folder / "queue", news.set)
        with disk.stalled():
            for number in range(50):
                assert commit.put(spool, b"%d" % number)
            assert not commit.wait(0.3)
            assert not news.is_set() and spool.batch(99)[0] == []
        assert commit.wait(LIMIT) and news.is_set()
        assert spool.batch(99)[0] == [b"%d" % number for number in range(50)]
        spool.close()


def test_what_counts_as_stored_is_there_after_a_power_cut(tmp_path: Path, commit: GroupCommit) -> None:
    with own_disk(tmp_path, SMALL) as disk:
        spool = Spool(disk.folder / "ts" / "queue", lambda: None)
        for line in (b"first", b"second"):
            assert commit.put(spool, line) and commit.wait(LIMIT)
        spool.write([b"not synced"])
        spool.close()
        disk.cut()
        left = Spool(disk.folder / "ts" / "queue", lambda: None)
        assert left.batch(9)[0] == [b"first", b"second"]
        left.close()


def test_those_that_come_while_the_disk_works_share_the_next_sync(commit: GroupCommit) -> None:
    sink = Sink()
    sink.works.clear()
    commit.put(sink, b"first", urgent=True)
    assert sink.syncing.wait(LIMIT)
    for _ in range(90):
        commit.put(sink, b"x")
    sink.works.set()
    assert commit.wait(LIMIT)
    assert len(sink.calls) == 2 and len(sink.stored) == 91


def test_what_others_rely_on_is_synced_first(commit: GroupCommit) -> None:
    calls: list[str] = []
    reported, record = Sink(calls, "told", 1), Sink(calls, "record", 0)
    for sink in (reported, record):
        commit.put(sink, b"x")
    assert commit.wait(LIMIT)
    assert calls == ["record", "told"]


def test_on_a_full_disk_entries_wait_in_their_order_and_each_is_stored_once(
    commit: GroupCommit, caplog: pytest.LogCaptureFixture
) -> None:
    sink, other = Sink(), Sink(order=1)
    other.full = 20
    for number in range(10):
        commit.put(sink, b"%d" % number)
        commit.put(other, b"%d" % number)
    assert other.syncing.wait(LIMIT)
    assert commit.wait(LIMIT) and commit.trouble() == ""
    assert sink.stored == other.stored == [b"%d" % number for number in range(10)]
    assert caplog.text.count("No space left on device") == 1


def test_the_memory_is_bounded_and_the_last_room_is_for_what_is_vital(commit: GroupCommit) -> None:
    sink = Sink()
    sink.works.clear()
    assert commit.put(sink, b"x" * 60)
    assert not commit.put(sink, b"x" * 60)
    assert commit.put(sink, b"y" * 60, vital=True)
    assert not commit.put(sink, b"y" * SPARE, vital=True)
    sink.works.set()
    assert commit.wait(LIMIT)
    assert sink.stored == [b"x" * 60, b"y" * 60]
    assert commit.put(sink, b"x" * 60)


def test_a_disk_that_is_full_or_silent_is_told(commit: GroupCommit, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(group_commit, "SLOW", 0.01)
    sink, full = Sink(), threading.Event()
    sink.works.clear()
    commit.put(sink, b"x")
    assert not commit.wait(0.05)
    assert "has not answered" in commit.trouble()
    sink.full = 1
    monkeypatch.setattr(group_commit, "RETRY", LIMIT)
    monkeypatch.setattr(commit, "_closed", full)
    sink.works.set()
    while "No space left" not in commit.trouble():
        assert not full.wait(0.005)
    full.set()  # ends the thread


def test_a_step_is_done_when_all_before_it_is_stored(commit: GroupCommit, caplog: pytest.LogCaptureFixture) -> None:
    sink, seen = Sink(), list[int]()

    def failing() -> None:
        raise OSError("read-only file system")

    commit.put(sink, b"x")
    commit.after(lambda: seen.append(len(sink.stored)))
    commit.after(failing)
    commit.put(sink, b"y")
    assert commit.wait(LIMIT)
    assert seen and seen[0] >= 1
    assert "read-only" in caplog.text


def test_closed_it_takes_nothing_and_nobody_waits_for_it() -> None:
    made, sink = GroupCommit(log), Sink()
    sink.works.clear()
    made.put(sink, b"x")
    made.close(0.01)
    assert not made.wait(LIMIT) and not made.put(sink, b"y")
    sink.works.set()
