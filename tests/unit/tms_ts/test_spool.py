"""Lines outlive the process, in order; only what is done is forgotten."""

import os
from pathlib import Path

import pytest

from tms_runtime import durable
from tms_ts import spool as module
from tms_ts.spool import PIECE, Spool


def opened(folder: Path, largest: int = module.LARGEST) -> Spool:
    return Spool(folder / "journal", lambda: None, largest)


def put(spool: Spool, *lines: bytes) -> None:
    """As group commit does."""
    spool.write(list(lines))
    spool.sync()
    spool.keep()


def test_lines_come_in_order_and_are_forgotten_when_done(tmp_path: Path) -> None:
    spool = opened(tmp_path)
    put(spool, b"0", b"1", b"2")
    put(spool, b"3", b"4")
    lines, end = spool.batch(3)
    assert lines == [b"0", b"1", b"2"]
    assert spool.batch(3)[0] == lines  # not done yet
    spool.done(end)
    assert spool.batch(9)[0] == [b"3", b"4"]
    spool.done(spool.batch(9)[1])
    assert not spool.waiting() and (tmp_path / "journal").stat().st_size == 0


def test_lines_can_be_taken_when_they_are_on_the_disk_and_not_before(tmp_path: Path) -> None:
    stored: list[int] = []
    spool = Spool(tmp_path / "journal", lambda: stored.append(1))
    put(spool, b"first")
    spool.write([b"second"])
    lines, end = spool.batch(9)
    assert lines == [b"first"] and stored == [1]
    spool.done(end)  # and keeps what is on its way
    spool.sync()
    spool.keep()
    assert spool.batch(9)[0] == [b"second"] and stored == [1, 1]


def test_what_was_not_done_waits_for_the_next_process(tmp_path: Path) -> None:
    spool = opened(tmp_path)
    put(spool, b"kept")
    spool.close()
    assert opened(tmp_path).batch(9)[0] == [b"kept"]


def test_a_line_cut_short_by_a_crash_does_not_spoil_the_next(tmp_path: Path) -> None:
    (tmp_path / "journal").write_bytes(b"whole\nhal")
    spool = opened(tmp_path)
    put(spool, b"next")
    put(spool, b"last")
    assert spool.batch(9)[0] == [b"whole", b"hal", b"next", b"last"]


def test_a_group_cut_short_by_a_full_disk_is_written_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(file: int, data: bytes) -> int:
        if len(data) < 9:
            raise OSError(28, "No space left on device")
        return write(file, data[:5])

    (tmp_path / "journal").write_bytes(b"whole\nhal")
    spool, write = opened(tmp_path), os.write
    with monkeypatch.context() as patch:
        patch.setattr(durable.os, "write", full)
        with pytest.raises(OSError, match="No space"):
            spool.write([b"first", b"second"])
    put(spool, b"first", b"second")
    lines, end = spool.batch(9)
    assert lines == [b"whole", b"hal", b"first", b"second"]
    spool.done(end)
    assert not spool.waiting()


def test_a_full_disk_keeps_no_process_from_starting(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> int:
        raise OSError(28, "No space left on device")

    (tmp_path / "journal").write_bytes(b"whole\nhal")
    monkeypatch.setattr(durable.os, "write", full)
    assert opened(tmp_path).batch(9)[0] == [b"whole"]


def test_a_disk_that_became_read_only_keeps_nobody_from_going_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: object) -> None:
        raise OSError(30, "Read-only file system")

    spool = opened(tmp_path)
    put(spool, b"line")
    monkeypatch.setattr(module.os, "ftruncate", refused)
    spool.done(spool.batch(9)[1])
    assert spool.batch(9)[0] == [] and opened(tmp_path).batch(9)[0] == [b"line"]


def test_it_is_bounded(tmp_path: Path) -> None:
    spool = opened(tmp_path, largest=10)
    put(spool, b"0123456789")
    assert spool.full()
    spool.done(spool.batch(9)[1])
    assert not spool.full()


def test_a_line_longer_than_a_batch_comes_alone_and_blocks_nobody(tmp_path: Path) -> None:
    spool = opened(tmp_path)
    long = b"x" * (5 * PIECE)
    put(spool, b"before", long, b"next")
    found = []
    for _ in range(3):
        lines, end = spool.batch(200)
        found.append(lines)
        spool.done(end)
    assert found == [[b"before"], [long], [b"next"]]
    assert not spool.waiting()


def test_what_is_done_does_not_fill_a_queue_that_never_gets_empty(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "OLD", 100)
    spool = opened(tmp_path, largest=300)
    put(spool, b"%030d" % 0)
    for number in range(1, 100):
        put(spool, b"%030d" % number)  # one more always waits
        assert not spool.full()
        lines, end = spool.batch(1)
        assert lines == [b"%030d" % (number - 1)]
        spool.done(end)
    assert [file.name for file in tmp_path.iterdir()] == ["journal"]
    assert (tmp_path / "journal").stat().st_mode & 0o777 == 0o600
    spool.close()
    assert opened(tmp_path).batch(9)[0][-1] == b"%030d" % 99


def test_a_full_disk_leaves_a_long_queue_where_it_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(module, "OLD", 1)
    spool = opened(tmp_path)
    put(spool, b"first", b"next")
    before = len(list(Path("/proc/self/fd").iterdir()))
    with monkeypatch.context() as patch:
        patch.setattr(durable.os, "write", full)
        spool.done(spool.batch(1)[1])
    assert len(list(Path("/proc/self/fd").iterdir())) == before
    put(spool, b"last")
    assert spool.batch(9)[0] == [b"next", b"last"]
