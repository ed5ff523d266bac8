"""What a crash leaves of a run is enough to close it and to go on with it."""

from dataclasses import replace
from pathlib import Path

import pytest
import structlog

from tms_decision.leaf.events import Key
from tms_decision.leaf.replay import Replay
from tms_ts.group_commit import GroupCommit
from tms_ts.interrupted_run import Header, Over, read
from tms_ts.run_checkpoint import LOST, Records

HEADER = Header("run-1", 7, 3, "dig", ["zx200"], "<root/>", (1, 2), values={"nodes": 3})
FIRST: Key = ("0.0", "zx200", "dig", "here")
SECOND: Key = ("0.1", "zx200", "dig", "there")


@pytest.fixture
def records(tmp_path: Path, disk: GroupCommit) -> Records:
    return Records(tmp_path, disk)


def test_a_crash_leaves_ended_and_open_leaves(records: Records) -> None:
    record = records.open("run-1")
    record.begin(HEADER)
    record.event(1)
    record.sent(FIRST)
    record.done(FIRST, True)
    record.sent(SECOND)
    record.event(2)
    records.past()
    with record.path.open("ab") as file:
        file.write(b'\n{"done": ["0.1", "zx2')  # cut short
    (past,) = records.past()
    assert past.header == HEADER and past.last_event == 2 and not past.closed
    assert past.ended == [(FIRST, True)] and past.open == [SECOND]


def test_a_run_that_ended_in_order_leaves_nothing(records: Records) -> None:
    record = records.open("run-1")
    record.begin(HEADER)
    record.remove()
    record.event(9)  # late news
    assert records.past() == []


def test_resumed_and_interrupted_again_it_keeps_what_had_ended(records: Records) -> None:
    record = records.open("run-1")
    record.begin(HEADER)
    record.sent(FIRST)
    record.done(FIRST, True)
    record.interrupted()
    assert records.past()[0].closed
    record = records.open("run-1")
    record.begin(HEADER)
    record.sent(SECOND)
    (past,) = records.past()
    assert not past.closed and past.ended == [(FIRST, True)] and past.open == [SECOND]


def test_what_a_resumed_run_did_not_ask_for_again_is_not_skipped_by_the_next_resume(records: Records) -> None:
    """Two rounds were done; resumed, it went another way after the first leaf, and was interrupted in its round."""
    other: Key = ("0.2", "zx200", "dig", "elsewhere")
    record = records.open("run-1")
    record.begin(HEADER)
    for key, succeeded in ((FIRST, True), (SECOND, True), (FIRST, False)):
        record.done(key, succeeded)
    replay = Replay(records.past()[0].ended)
    record.begin(HEADER)
    assert replay.take(FIRST) is True
    for key, left in replay.moved_on(other[0]):
        record.gone(key, left)
    record.done(other, True)
    assert replay.moved_on(other[0]) == []
    record.sent(FIRST)
    assert records.past()[0].ended == [(FIRST, True), (other, True)]


def test_a_run_is_found_by_the_beginning_of_its_id(records: Records) -> None:
    records.open("run-1").begin(HEADER)
    assert records.find("run") is not None
    assert records.find("") is None and records.find("other") is None


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


def test_lines_that_no_memory_is_left_for_are_counted_and_told(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    disk, lost = GroupCommit(structlog.stdlib.get_logger("disk"), 0), LOST._value.get()
    Records(tmp_path, disk).open("r").event(1)
    assert LOST._value.get() == lost + 1
    assert "event=record_lost file=r.jsonl line=n" in caplog.text
    disk.close(10)


def test_a_record_that_is_closed_stays(records: Records) -> None:
    made = records.open("r")
    made.event(1)
    made.close()
    made.close()
    made.event(2)  # late news
    records.past()
    assert read(made.path).last_event == 1


def test_a_record_is_there_until_the_end_of_its_run_is_stored(records: Records, disk: GroupCommit) -> None:
    record, seen = records.open("run-1"), list[bool]()
    record.begin(HEADER)
    record.event(4)
    record.over("failure", "it rains")
    record.event(5)
    disk.after(lambda: seen.append(read(record.path).over == Over("failure", "it rains", 5)))
    record.remove()
    assert disk.wait(10)
    assert seen == [True] and not record.path.exists()


def test_a_run_that_is_resumed_is_not_over(records: Records) -> None:
    record = records.open("run-1")
    record.begin(HEADER)
    record.over("failure", "")
    record.begin(HEADER)
    (past,) = records.past()
    assert past.over is None


def test_the_time_of_a_machine_s_last_goal_is_known(records: Records) -> None:
    record = records.open("run-1")
    record.begin(HEADER)
    record.sent(FIRST)
    (past,) = records.past()
    assert 0 < past.sent_at["zx200"] <= past.last_time and "ic120" not in past.sent_at


@pytest.mark.parametrize(
    "left", [b"", b"\0" * 4096, b'\n{"run": {"run_id": "x"}}\n', b'\n{"n": 3}', b"\xff\xfe\n[]\n7"]
)
def test_a_record_without_its_run_is_told_kept_aside_and_keeps_nobody_from_starting(
    tmp_path: Path, records: Records, left: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    records.open("good").begin(HEADER)
    assert len(records.past()) == 1
    folder = tmp_path / "ts" / "runs"
    (folder / "bad.jsonl").write_bytes(left)
    (folder / "empty.jsonl").mkdir()
    records.check()
    assert caplog.text.count("event=record_unreadable") == 2
    assert (folder / "bad.jsonl.unreadable").read_bytes() == left
    assert [past.header and past.header.run_id for past in records.past()] == ["run-1"]


def test_damaged_lines_are_told_and_the_others_count(
    tmp_path: Path, records: Records, caplog: pytest.LogCaptureFixture
) -> None:
    record = records.open("run-1")
    record.begin(HEADER)
    records.past()
    with record.path.open("ab") as file:
        file.write(b'\n\0\0\0\n{"sent": 7}\n{"done": ["0.0", "zx200", "dig", "here"], "ok": true}\n{"n": "x"}\n{"n": 1')
    records.check()
    assert "event=record_damaged" in caplog.text and "lines=3" in caplog.text
    (past,) = records.past()
    assert past.ended == [(FIRST, True)] and past.header == HEADER


def test_a_record_of_an_earlier_version_is_read(tmp_path: Path, records: Records) -> None:
    folder = tmp_path / "ts" / "runs"
    folder.mkdir(parents=True)
    line = '{"run": {"run_id": "run-1", "number": 7, "task_id": 3, "description": "dig", "machines": ["zx200"], '
    (folder / "run-1.jsonl").write_text("\n" + line + '"xml": "<root/>", "started": [1, 2]}, "t": 5.0}')
    assert [past.header for past in records.past()] == [replace(HEADER, values={})]
