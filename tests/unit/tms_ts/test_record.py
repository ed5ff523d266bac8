"""What a crash leaves of a run is enough to close it and to go on with it."""

import os
from pathlib import Path

import pytest

from tms_ts.record import LOST, Header, Key, Past, Records, Replay

HEADER = Header("run-1", 7, 3, "dig", ["zx200"], "<root/>", (1, 2))
FIRST: Key = ("0.0", "zx200", "dig", "here")
SECOND: Key = ("0.1", "zx200", "dig", "there")


def test_a_crash_leaves_ended_and_open_leaves(tmp_path: Path) -> None:
    record = Records(tmp_path).open("run-1")
    record.begin(HEADER)
    record.event(1)
    record.sent(FIRST)
    record.done(FIRST, True)
    record.sent(SECOND)
    record.event(2)
    with record.path.open("ab") as file:
        file.write(b'\n{"done": ["0.1", "zx2')  # cut short
    (past,) = Records(tmp_path).past()
    assert past.header == HEADER and past.last_event == 2 and not past.closed
    assert past.ended == [(FIRST, True)] and past.open == [SECOND]


def test_a_run_that_ended_in_order_leaves_nothing(tmp_path: Path) -> None:
    record = Records(tmp_path).open("run-1")
    record.begin(HEADER)
    record.remove()
    record.event(9)  # late news
    assert Records(tmp_path).past() == []


def test_resumed_and_interrupted_again_it_keeps_what_had_ended(tmp_path: Path) -> None:
    record = Records(tmp_path).open("run-1")
    record.begin(HEADER)
    record.sent(FIRST)
    record.done(FIRST, True)
    record.interrupted()
    assert Records(tmp_path).past()[0].closed
    record = Records(tmp_path).open("run-1")
    record.begin(HEADER)
    record.sent(SECOND)
    (past,) = Records(tmp_path).past()
    assert not past.closed and past.ended == [(FIRST, True)] and past.open == [SECOND]


def test_what_a_resumed_run_did_not_ask_for_again_is_not_skipped_by_the_next_resume(tmp_path: Path) -> None:
    """Two rounds were done; resumed, it went another way after the first leaf, and was interrupted in its round."""
    other: Key = ("0.2", "zx200", "dig", "elsewhere")
    record = Records(tmp_path).open("run-1")
    record.begin(HEADER)
    for key, succeeded in ((FIRST, True), (SECOND, True), (FIRST, False)):
        record.done(key, succeeded)
    replay = Replay(Past(record.path).ended)
    record.begin(HEADER)
    assert replay.take(FIRST) is True
    for key, left in replay.moved_on(other[0]):
        record.gone(key, left)
    record.done(other, True)
    assert replay.moved_on(other[0]) == []
    record.sent(FIRST)
    assert Past(record.path).ended == [(FIRST, True), (other, True)]


def test_a_run_is_found_by_the_beginning_of_its_id(tmp_path: Path) -> None:
    Records(tmp_path).open("run-1").begin(HEADER)
    assert Records(tmp_path).find("run") is not None
    assert Records(tmp_path).find("") is None and Records(tmp_path).find("other") is None


def test_ended_leaves_are_replayed_once_each_and_in_order() -> None:
    replay = Replay([(FIRST, True), (SECOND, False), (FIRST, False)])
    assert [replay.take(FIRST), replay.take(FIRST), replay.take(FIRST)] == [True, False, None]
    assert [replay.take(SECOND), replay.take(SECOND)] == [False, None]


def test_what_the_tree_did_not_ask_for_again_is_done_again() -> None:
    """No truck is there now: the tree poses, and digs for the next truck what it had dug for the last one."""
    pose: Key = ("0.0.1.0", "zx200", "pose", "start")
    dig: Key = ("0.0.1.1", "zx200", "dig", "here")
    drive: Key = ("0.1.0", "ic120", "drive", "there")
    replay = Replay([(pose, True), (dig, True), (drive, True)])
    replay.beside = lambda node, other: node.split(".")[1] != other.split(".")[1]  # two branches of a Parallel
    assert replay.take(pose) is True
    assert replay.take(pose) is None
    replay.moved_on(pose[0])
    assert replay.take(dig) is None
    assert replay.take(drive) is True


def test_a_full_disk_keeps_nobody_from_going_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = Records(tmp_path).open("r")

    def full(*_: object) -> int:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("tms_ts.record.os.write", full)
        made.event(1)
    made.event(2)
    assert Past(made.path).last_event == 2


def test_a_line_cut_short_by_a_full_disk_does_not_spoil_the_next(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    made, write, lost = Records(tmp_path).open("r"), os.write, LOST._value.get()
    made.done(FIRST, True)
    with monkeypatch.context() as patch:
        patch.setattr("tms_ts.record.os.write", lambda file, data: write(file, data[: len(data) // 2]))
        made.done(SECOND, True)
    made.done(SECOND, False)
    assert Past(made.path).ended == [(FIRST, True), (SECOND, False)]
    assert LOST._value.get() == lost + 1
    assert "event=record_lost" in caplog.text


def test_a_record_that_is_closed_stays(tmp_path: Path) -> None:
    made = Records(tmp_path).open("r")
    made.event(1)
    made.close()
    made.close()
    made.event(2)  # late news
    assert Past(made.path).last_event == 1
