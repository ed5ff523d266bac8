"""Lines outlive the process, in order; only what is done is forgotten."""

from pathlib import Path

import pytest

from tms_ts.spool import Spool, SpoolFull


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


def test_it_is_bounded(tmp_path: Path) -> None:
    spool = Spool(tmp_path / "journal", largest=10)
    spool.put(b"0123456789")
    with pytest.raises(SpoolFull):
        spool.put(b"more")
