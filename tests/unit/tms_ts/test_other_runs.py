"""What the runs of other schedulers hold and write, as they tell it."""

from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_ts.msg import RunState, RunStates

from tms_schedulers import hearing
from tms_schedulers.names import Scheduler
from tms_ts import other_runs
from tms_ts.other_runs import OtherRuns, orders_told, writes_told

MAIN, EAST = Scheduler("tms:ts", frozenset()), Scheduler("tms:ts_east", frozenset(), "/tms/ts_east")
ORDERS = {"ic120": {("road", "yard"), ("gate", "road")}}


def run(run_id: str) -> RunState:
    return RunState(run_id=run_id, orders=orders_told(ORDERS), writes=writes_told({("LOADING", "TRUCK_READY")}))


def heard(monkeypatch: pytest.MonkeyPatch, *messages: RunStates, of: tuple[Scheduler, ...] = (MAIN, EAST)) -> OtherRuns:
    """By the main scheduler, from the other one; the next message with each question."""
    monkeypatch.setattr(other_runs, "schedulers", lambda _: of)
    monkeypatch.setattr(hearing, "schedulers", lambda _: of)
    waiting = list(messages)

    def sample(_: Any, topic: str) -> Any:
        return lambda: [waiting.pop(0)] if waiting and topic == "/tms/ts_east/runs" else []

    app: Any = SimpleNamespace(site=None, ros=SimpleNamespace(sample=sample))
    return OtherRuns(app, MAIN)


def test_orders_and_values_are_those_of_the_runs_that_the_other_one_told_last(monkeypatch: pytest.MonkeyPatch) -> None:
    theirs = RunStates(runs=[run("20261129-060000-1a2b-east")])
    assert heard(monkeypatch, theirs).orders() == ORDERS
    found = heard(monkeypatch, theirs)
    assert found.writes("LOADING", "TRUCK_READY") and not found.writes("LOADING", "TRUCK_LOADED")
    assert found.orders() == ORDERS, "nothing new was told"
    ended = heard(monkeypatch, theirs, RunStates())
    assert ended.orders() and not ended.orders()


def test_own_runs_are_not_among_them(monkeypatch: pytest.MonkeyPatch) -> None:
    own = RunStates(runs=[run("20261129-060000-1a2b")])
    found = heard(monkeypatch, own)
    assert not found.orders() and not found.writes("LOADING", "TRUCK_READY")


def test_the_only_scheduler_hears_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    found = heard(monkeypatch, RunStates(runs=[run("20261129-060000-1a2b-east")]), of=(MAIN,))
    assert not found.orders() and not found.writes("LOADING", "TRUCK_READY")
