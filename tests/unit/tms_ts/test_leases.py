"""A scheduler among several: leases of its runs are taken, renewed and given back; tasks of others are refused."""

import threading
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_db.srv import LeaseMachines

from tms_reason.errors import RosError, TaskError
from tms_reason.reason import Reason
from tms_ros.reasons import NoServer
from tms_schedulers.names import Scheduler
from tms_schedulers.reasons import MachineLeased, OtherScheduler
from tms_ts import leases
from tms_ts.active_runs import ActiveRuns
from tms_ts.leases import RENEW, Leases

MAIN = Scheduler("tms:ts", frozenset({"zx200"}))
EAST = Scheduler("tms:ts_east", frozenset({"ic120"}), "/tms/ts_east")
AWAY = RosError(NoServer("tms:db", leases.SERVICE, 5.0))


class Run:
    """A run with machines."""

    def __init__(self, run_id: str, number: int, *machines: str) -> None:
        self.facts: Any = SimpleNamespace(run_id=run_id, number=number, machines=list(machines))
        self.ends: list[tuple[str, Reason]] = []

    def cancel(self, outcome: str, reason: Reason) -> None:
        self.ends.append((outcome, reason))


class Pc:
    """The main scheduler, with a keeper of leases that may be away or refuse."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *every: Scheduler) -> None:
        self.now, self.heard, self.answer = 100.0, list[LeaseMachines.Request](), LeaseMachines.Response(last=7)
        self.refuses: RosError | None = None
        self.there = {"/tms/ts_east/cancel_run"}
        self.steps: list[Any] = []
        monkeypatch.setattr(leases, "monotonic", lambda: self.now)
        monkeypatch.setattr(leases, "schedulers", lambda _: every)
        monkeypatch.setattr(leases, "own", lambda *_: MAIN)
        monkeypatch.setattr(leases, "ask", self._ask)
        monkeypatch.setattr(
            leases, "responsible", lambda _, names: next((one for one in every if set(names) <= one.machines), MAIN)
        )
        ros = SimpleNamespace(
            prepare=lambda *_: None, poll_in_thread=lambda _, step, __: self.steps.append(step),
            has_service=lambda _, name: name in self.there,
        )  # fmt: skip
        app: Any = SimpleNamespace(
            ros=ros, site=None, process=SimpleNamespace(full="tms:ts"), stopping=threading.Event()
        )
        self.runs = ActiveRuns()
        self.leases = Leases(app, self.runs)

    def _ask(self, _ros: Any, _kind: Any, _name: str, request: LeaseMachines.Request, _limit: float) -> Any:
        if self.refuses is not None:
            raise self.refuses
        self.heard.append(request)
        return self.answer

    def look(self, later: float = 0.0) -> None:
        self.now += later
        for step in self.steps:
            step()


@pytest.fixture
def pc(monkeypatch: pytest.MonkeyPatch) -> Iterator[Pc]:
    yield Pc(monkeypatch, MAIN, EAST)


def test_a_single_scheduler_asks_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    pc, run = Pc(monkeypatch, MAIN), Run("r", 9, "zx200")
    pc.leases.take(run.facts)
    pc.leases.give_back(run.facts)
    pc.look(RENEW)
    assert not pc.leases.several and pc.leases.last() == 0 and pc.heard == [] and pc.steps == []


def test_numbers_of_new_runs_are_above_those_of_the_site(pc: Pc) -> None:
    assert pc.leases.several and pc.leases.last() == 7


def test_a_run_has_its_machines_until_it_gives_them_back(pc: Pc) -> None:
    run: Any = Run("r", 9, "zx200", "ic120")
    pc.leases.take(run.facts)
    pc.runs.add(run)
    pc.runs.hold(run)
    pc.look(RENEW / 2)
    assert [(one.run_id, one.number, list(one.machines), one.over) for one in pc.heard] == [
        ("r", 9, ["zx200", "ic120"], False)
    ]
    pc.look(RENEW / 2)
    assert len(pc.heard) == 2 and pc.heard[1] == pc.heard[0], "renewed"
    pc.runs.remove(run)
    pc.leases.give_back(run.facts)
    pc.look()
    pc.look()
    assert len(pc.heard) == 3 and pc.heard[2].over and pc.heard[2].scheduler == "tms:ts"


def test_what_could_not_be_given_back_is_given_back_later_while_that_matters(pc: Pc) -> None:
    pc.refuses = AWAY
    pc.leases.give_back(Run("r", 9, "zx200").facts)
    pc.look()
    pc.refuses = None
    pc.look()
    assert [one.run_id for one in pc.heard] == ["r"]
    pc.refuses = AWAY
    pc.leases.give_back(Run("s", 10, "zx200").facts)
    pc.look(leases.LEASE)
    pc.refuses = None
    pc.look()
    assert "s" not in [one.run_id for one in pc.heard]


def test_a_run_goes_on_while_nobody_renews_and_ends_when_another_has_its_machine(pc: Pc) -> None:
    run: Any = Run("r", 9, "zx200")
    pc.runs.add(run)
    pc.runs.hold(run)
    pc.refuses = AWAY
    pc.look(RENEW)
    assert run.ends == []
    taken = MachineLeased("zx200", "x-east", "tms:ts_east")
    pc.refuses = RosError(taken)
    pc.look(RENEW)
    assert run.ends == [("cancelled", taken)]


def test_a_machine_of_another_s_run_is_not_to_be_had(pc: Pc) -> None:
    pc.refuses = RosError(MachineLeased("zx200", "x-east", "tms:ts_east"))
    with pytest.raises(RosError) as caught:
        pc.leases.take(Run("r", 9, "zx200").facts)
    assert caught.value.code == "MACHINE_LEASED"


def test_a_task_of_another_scheduler_is_refused_while_that_one_is_there(pc: Pc) -> None:
    pc.leases.refuse_other(["zx200"])
    pc.leases.refuse_other(["zx200", "ic120"])
    with pytest.raises(TaskError) as caught:
        pc.leases.refuse_other(["ic120"])
    assert caught.value.reason == OtherScheduler("tms:ts_east", ("ic120",))
    pc.there = set()
    pc.leases.refuse_other(["ic120"])
