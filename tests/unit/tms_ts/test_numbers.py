"""Fencing numbers only grow, and are on the disk before they are used."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from power_cut import own_disk
from slow_disk import SMALL, slow_disk
from tms_reason.errors import TaskError
from tms_ts import numbers as module
from tms_ts.group_commit import GroupCommit
from tms_ts.numbers import Numbers


def test_they_grow_over_restarts_and_when_the_clock_goes_back(tmp_path: Path, disk: GroupCommit) -> None:
    first = Numbers(tmp_path, disk).next()
    assert abs(first - time.time() * 1000) < 60_000
    (tmp_path / "ts" / "number").write_text(str(first + 10_000_000))
    assert Numbers(tmp_path, disk).next() == first + 10_000_001
    assert Numbers(tmp_path, disk).next() == first + 10_000_002


@pytest.mark.parametrize("left", [b"", b"17a", b"\0\0\0\0", b"\xff\xfe"])
def test_a_file_that_cannot_be_read_is_told_and_kept_aside(
    tmp_path: Path, disk: GroupCommit, left: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "ts").mkdir()
    (tmp_path / "ts" / "number").write_bytes(left)
    numbers = Numbers(tmp_path, disk)
    assert "event=number_unreadable" in caplog.text
    assert (tmp_path / "ts" / "number.unreadable").read_bytes() == left
    assert abs(numbers.next() - time.time() * 1000) < 60_000
    assert Numbers(tmp_path, disk).next() > 1


def test_runs_that_start_at_once_get_different_numbers(tmp_path: Path, disk: GroupCommit) -> None:
    numbers = Numbers(tmp_path, disk)
    with ThreadPoolExecutor(20) as pool:
        given = list(pool.map(lambda _: numbers.next(), range(400)))
    assert len(set(given)) == len(given)
    assert int((tmp_path / "ts" / "number").read_text()) == max(given)


def test_a_number_that_was_given_is_there_after_a_power_cut(tmp_path: Path, disk: GroupCommit) -> None:
    with own_disk(tmp_path, SMALL) as own:
        given = Numbers(own.folder, disk).next()
        own.cut()
        assert int((own.folder / "ts" / "number").read_text()) == given


def test_on_a_disk_that_stalls_no_number_is_given_before_it_is_stored(tmp_path: Path, disk: GroupCommit) -> None:
    given: list[int] = []
    with slow_disk(tmp_path) as slow:
        numbers = Numbers(slow.folder, disk)
        first = numbers.next()
        asking = threading.Thread(target=lambda: given.append(numbers.next()))
        with slow.stalled():
            asking.start()
            asking.join(0.3)
            assert given == []
        asking.join(10)
        assert given and given[0] > first


def test_a_run_is_refused_when_its_number_cannot_be_stored(
    tmp_path: Path, disk: GroupCommit, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(module, "DISK_LIMIT", 0.2)
    numbers = Numbers(tmp_path, disk)
    with monkeypatch.context() as patch:
        patch.setattr(module.durable, "replace", full)
        with pytest.raises(TaskError, match=r"does not take .* No space left .*: free some space") as refused:
            numbers.next()
        assert refused.value.code == "NO_DISK"
    assert disk.wait(10)
    assert numbers.next() > 0
