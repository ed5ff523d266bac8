"""Lines outlive the process, in order; only what is done is forgotten."""

import os
from pathlib import Path

import pytest

from tms_ts import spool as module
from tms_ts.spool import PIECE, Spool, SpoolFull


def test_lines_come_in_order_and_are_forgotten_when_done(tmp_path: Path) -> None:
    spool = Spool(tmp_path / "journal")
    for number in range(5):
        spool.put(b"%d" % number)
    lines, end = spool.batch(3)
    assert lines == [b"0", b"1", b"2"]
    assert spool.batch(3)[0] == lines  # not done yet
    spool.done(end)
    assert spool.batch(9)[0] == [b"3", b"4"]
    spool.done(spool.batch(9)[1])
    assert not spool.waiting() and (tmp_path / "journal").stat().st_size == 0


def test_what_was_not_done_waits_for_the_next_process(tmp_path: Path) -> None:
    spool = Spool(tmp_path / "journal")
    spool.put(b"kept")
    spool.close()
    assert Spool(tmp_path / "journal").batch(9)[0] == [b"kept"]


def test_a_line_cut_short_by_a_crash_does_not_spoil_the_next(tmp_path: Path) -> None:
    (tmp_path / "journal").write_bytes(b"whole\nhal")
    spool = Spool(tmp_path / "journal")
    spool.put(b"next")
    assert spool.batch(9)[0] == [b"whole", b"hal", b"next"]


def test_a_line_cut_short_by_a_full_disk_does_not_spoil_the_next(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    spool, write = Spool(tmp_path / "journal"), os.write
    spool.put(b"whole")
    with monkeypatch.context() as patch:
        patch.setattr("tms_ts.spool.os.write", lambda file, data: write(file, data[:3]))
        with pytest.raises(OSError, match="only 3 of 7 bytes"):
            spool.put(b"halved")
    for line in (b"next", b"last"):
        spool.put(line)
    lines, end = spool.batch(9)
    assert lines == [b"whole", b"hal", b"next", b"last"]
    spool.done(end)
    assert not spool.waiting()


def test_a_full_disk_keeps_no_process_from_starting(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> int:
        raise OSError(28, "No space left on device")

    (tmp_path / "journal").write_bytes(b"whole\nhal")
    monkeypatch.setattr("tms_ts.spool.os.write", full)
    assert Spool(tmp_path / "journal").batch(9)[0] == [b"whole"]


def test_it_is_bounded(tmp_path: Path) -> None:
    spool = Spool(tmp_path / "journal", largest=10)
    spool.put(b"0123456789")
    with pytest.raises(SpoolFull):
        spool.put(b"more")


def test_a_line_longer_than_a_batch_comes_alone_and_blocks_nobody(tmp_path: Path) -> None:
    spool = Spool(tmp_path / "journal")
    long = b"x" * (5 * PIECE)
    for line in (b"before", long, b"next"):
        spool.put(line)
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
    spool = Spool(tmp_path / "journal", largest=300)
    spool.put(b"%030d" % 0)
    for number in range(1, 100):
        spool.put(b"%030d" % number)  # one more always waits
        lines, end = spool.batch(1)
        assert lines == [b"%030d" % (number - 1)]
        spool.done(end)
    assert [file.name for file in tmp_path.iterdir()] == ["journal"]
    assert (tmp_path / "journal").stat().st_mode & 0o777 == 0o600
    spool.close()
    assert Spool(tmp_path / "journal").batch(9)[0][-1] == b"%030d" % 99
