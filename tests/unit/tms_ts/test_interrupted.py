"""An interrupted run is resumed or abandoned once, whoever asks at the same time."""

import logging
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from tms_msg_ts.srv import CancelRun

from tms_core.errors import TaskError
from tms_ts.interrupted import Interrupted
from tms_ts.record import Header, Past, Records

HEADER = Header("run-1", 7, 3, "dig", ["zx200"], "<root/>", (1, 2))


class Slow(Records):
    """Reads for so long that the other one comes, if it can."""

    def __init__(self, state: Path) -> None:
        super().__init__(state)
        self._meet = threading.Barrier(2)

    def find(self, run_id: str) -> Past | None:
        found = super().find(run_id)
        try:
            self._meet.wait(0.5)
        except threading.BrokenBarrierError:
            pass  # nobody else was let in
        return found


def interrupted(tmp_path: Path, journal: list[Any]) -> Interrupted:
    records = Slow(tmp_path)
    record = records.open("run-1")
    record.begin(HEADER)
    record.interrupted()
    app = SimpleNamespace(stopping=threading.Event(), log=logging.getLogger("test"), ros=SimpleNamespace(now=Time))
    return Interrupted(app, SimpleNamespace(put=journal.append), records)  # type: ignore[arg-type]


def test_a_lost_run_that_is_closed_leaves_no_open_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    journal: list[Any] = []
    monkeypatch.setattr(threading.Thread, "start", lambda _: None)
    runs = interrupted(tmp_path, journal)
    (past,) = Records(tmp_path).past()
    before = len(list(Path("/proc/self/fd").iterdir()))
    runs._close(past, HEADER)
    assert len(list(Path("/proc/self/fd").iterdir())) == before
    assert journal[-1].state == "interrupted"


@pytest.mark.parametrize("second", ["resume", "abandon"])
def test_of_two_that_ask_at_once_one_gets_the_run(tmp_path: Path, second: str) -> None:
    journal: list[Any] = []
    runs, got, refused = interrupted(tmp_path, journal), list[str](), list[str]()

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
