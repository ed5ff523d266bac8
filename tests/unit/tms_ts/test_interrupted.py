"""An interrupted run is resumed or abandoned once, whoever asks at the same time."""

import threading
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import structlog
from builtin_interfaces.msg import Time
from tms_msg_rc.msg import StopReceipt
from tms_msg_ts.srv import CancelRun

from tms_decision.past import CLOSE_LIMIT
from tms_decision.reasons import RunInterrupted
from tms_machine.values import from_parameters
from tms_reason import wire
from tms_reason.errors import TaskError
from tms_ts.group_commit import GroupCommit
from tms_ts.interrupted import Interrupted
from tms_ts.interrupted_run import Header, InterruptedRun
from tms_ts.run_checkpoint import Records
from words import words

HEADER = Header("run-1", 7, 3, "dig", ["zx200"], "<root/>", (1, 2), values={"nodes": 3})


class Slow(Records):
    """Reads for so long that the other one comes, if it can."""

    def __init__(self, state: Path, disk: GroupCommit) -> None:
        super().__init__(state, disk)
        self._meet = threading.Barrier(2)

    def find(self, run_id: str) -> InterruptedRun | None:
        found = super().find(run_id)
        try:
            self._meet.wait(0.5)
        except threading.BrokenBarrierError:
            pass  # nobody else was let in
        return found


def interrupted(records: Records, journal: list[Any]) -> Interrupted:
    record = records.open("run-1")
    record.begin(HEADER)
    record.interrupted()
    return successor(records, journal)


def successor(records: Records, journal: list[Any]) -> Interrupted:
    app = SimpleNamespace(
        stopping=threading.Event(), log=structlog.stdlib.get_logger("test"), ros=SimpleNamespace(now=Time)
    )
    places = SimpleNamespace(free_all=lambda *_: None)
    return Interrupted(app, SimpleNamespace(put=journal.append), records, places)  # type: ignore[arg-type]


def test_a_lost_run_that_is_closed_leaves_no_open_file(
    tmp_path: Path, disk: GroupCommit, monkeypatch: pytest.MonkeyPatch
) -> None:
    journal: list[Any] = []
    monkeypatch.setattr(threading.Thread, "start", lambda _: None)
    records = Slow(tmp_path, disk)
    runs = interrupted(records, journal)
    (past,) = records.past()
    before = len(list(Path("/proc/self/fd").iterdir()))
    runs._close(past, HEADER)
    assert disk.wait(10)
    assert len(list(Path("/proc/self/fd").iterdir())) == before
    assert journal[-1].state == "interrupted"
    assert from_parameters(journal[-1].values) == {"nodes": 3}


@pytest.mark.parametrize("second", ["resume", "abandon"])
def test_of_two_that_ask_at_once_one_gets_the_run(tmp_path: Path, disk: GroupCommit, second: str) -> None:
    journal: list[Any] = []
    runs, got, refused = interrupted(Slow(tmp_path, disk), journal), list[str](), list[str]()

    def resume() -> None:
        try:
            got.append(runs.begin("run-1")[1].run_id)
        except TaskError as error:
            refused.append(error.code)

    def abandon() -> None:
        answer = runs.abandon(CancelRun.Request(run_id="run-1"), CancelRun.Response())
        (refused if answer.error_code else got).append(answer.error_code or "abandoned")

    threads = [threading.Thread(target=resume), threading.Thread(target={"resume": resume, "abandon": abandon}[second])]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(10)
    assert (len(got), refused) == (1, ["NO_RUN"])
    assert (got == ["abandoned"]) == bool(journal)


def lost_run(tmp_path: Path, disk: GroupCommit, machines: list[str]) -> tuple[Records, float]:
    """A record as a lost scheduler left it, and when it was written last [s since 1970]."""
    records = Records(tmp_path, disk)
    record = records.open("run-1")
    record.begin(replace(HEADER, machines=machines, records=["zx200/here"]))
    record.event(4)
    return records, records.past()[0].last_time


def receipt(
    machine: str, at: float, run: int = HEADER.number, confirmed: bool = True, latched: bool = True
) -> StopReceipt:
    stamp = Time(sec=int(at), nanosec=int(at % 1 * 1e9))
    return StopReceipt(
        machine=machine, confirmed=confirmed, latched=latched, seconds=0.5, cause="no scheduler", detail="silent",
        stamp=stamp, run=run,
    )  # fmt: skip


def closed(records: Records, receipts: list[StopReceipt], monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What the history gets to know."""
    journal: list[Any] = []
    monkeypatch.setattr(threading.Thread, "start", lambda _: None)
    runs = successor(records, journal)
    for one in receipts:
        runs.receipt(one)
    monkeypatch.setattr("tms_ts.interrupted.CLOSE_LIMIT", 0.0)
    runs._close_all()
    return journal


def test_the_history_claims_no_stop_that_nobody_saw(
    tmp_path: Path, disk: GroupCommit, monkeypatch: pytest.MonkeyPatch
) -> None:
    records, last = lost_run(tmp_path, disk, ["zx200", "ic120", "zx120", "mst110cr"])
    receipts = [
        receipt("zx200", last + 0.6),
        receipt("ic120", last + 0.7, confirmed=False),
        receipt("zx120", last + 0.6, run=8),  # of another run
        receipt("mst110cr", last - 60.0),  # of an earlier stop
    ]
    journal = closed(records, receipts, monkeypatch)
    assert [(row.kind, words(row.text)) for row in journal[:-2]] == [
        ("stop", "zx200 stood after 0.50 s, 0.00 m: no scheduler"),
        ("stop", "ic120: STOP UNCONFIRMED: silent (no scheduler)"),
        ("alarm", "ic120: STOP UNCONFIRMED: silent (no scheduler)"),
        ("alarm", "zx120: not seen to stand: no receipt of a stop came within 20.0 s"),
        ("alarm", "mst110cr: not seen to stand: no receipt of a stop came within 20.0 s"),
    ]
    row = journal[-1]
    assert (row.state, list(row.records)) == ("interrupted", ["zx200/here"])
    assert words(row.reason) == (
        "the scheduler was lost; seen to stand: zx200; not seen to stand: ic120, zx120, mst110cr"
    )
    assert wire.known(row.reason).find(RunInterrupted).run == "run-1"
    assert [event.number for event in journal[:-1]] == [5, 6, 7, 8, 9, 10]
    assert records.past()[0].closed and CLOSE_LIMIT > 5.0  # s that the gateways take


@pytest.mark.parametrize(("receipts", "seen"), [([0.6], True), ([-0.2], False), ([0.6, -0.2], True)])
def test_a_machine_that_got_a_goal_after_its_stop_was_not_seen_to_stand(
    tmp_path: Path, disk: GroupCommit, monkeypatch: pytest.MonkeyPatch, receipts: list[float], seen: bool
) -> None:
    records, _ = lost_run(tmp_path, disk, ["zx200"])
    records.open("run-1").sent(("0.0", "zx200", "dig", "here"))
    last = records.past()[0].last_time
    row = closed(records, [receipt("zx200", last + at) for at in receipts], monkeypatch)[-1]
    assert ("; seen to stand: zx200" in words(row.reason)) == seen != ("not seen to stand: zx200" in words(row.reason))


def test_a_run_whose_end_the_power_cut_came_upon_has_ended_and_is_not_interrupted(
    tmp_path: Path, disk: GroupCommit, monkeypatch: pytest.MonkeyPatch
) -> None:
    records, _ = lost_run(tmp_path, disk, ["zx200"])
    record = records.open("run-1")
    record.over("failure", "it rains")
    record.event(5)
    event, row = closed(records, [], monkeypatch)
    assert (event.number, event.kind, words(event.text)) == (5, "run", "failure: it rains")
    assert (row.state, words(row.reason)) == ("failure", "it rains") and row.ended_at.sec > 0
    assert records.past() == []


def test_a_stop_that_a_waiting_goal_may_have_followed_is_no_end(
    tmp_path: Path, disk: GroupCommit, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The gateway had just started and stopped its machine, when a run sent its first goal, which waited for that."""
    records, last = lost_run(tmp_path, disk, ["zx200"])
    row = closed(records, [receipt("zx200", last + 0.1, latched=False)], monkeypatch)[-1]
    assert "not seen to stand: zx200" in words(row.reason)
