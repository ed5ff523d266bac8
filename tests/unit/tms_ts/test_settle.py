"""However a run ends, its machines are stopped; and it ticks as long as it lasts."""

import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import structlog
from builtin_interfaces.msg import Time
from tms_msg_rc.msg import StopReceipt
from tms_msg_ts.action import ExecuteTask

from tms_decision.reasons import MachineLatched, SoftwareStop, StopUnconfirmed
from tms_machine.values import from_parameters
from tms_reason import wire
from tms_reason.reason import Foreign, Reason
from tms_reason.wire import to_line
from tms_ros.goals import Outcome
from tms_ts.active_runs import ActiveRuns
from tms_ts.bt import Status
from tms_ts.budget import MAX_BURST
from tms_ts.execution import END_STORED, Execution
from tms_ts.facts import Facts
from tms_ts.group_commit import GroupCommit
from tms_ts.interrupted_run import read
from tms_ts.reasons import LeftOut
from tms_ts.run import TICK_PERIOD, Run
from tms_ts.run_checkpoint import Records
from words import words


class Machines:
    """Those of the run; what was asked of them. `open` are goals that end when the machine is stopped."""

    def __init__(self, *open_goals: str, confirmed: bool = True) -> None:
        self.open, self.stopped, self._confirmed = list(open_goals), list[str](), confirmed
        self.stops = self

    def stop_all(self, machines: list[str], cause: Reason) -> list[Any]:
        self.stopped += machines
        self.open.clear()
        return [StopReceipt(machine=name, confirmed=self._confirmed, cause=to_line(cause)) for name in machines]

    def receipt(self, receipt: Any) -> None: ...

    def settled(self) -> bool:
        return not self.open

    def open_goals(self) -> list[str]:
        return self.open

    def advance(self) -> None: ...


def broken() -> None:
    raise RuntimeError("a bug")


@pytest.fixture
def rows() -> list[Any]:
    """What the run puts into the history."""
    return []


def new_run(rows: list[Any], record: Any, resume: str = "") -> Run:
    return Run(
        SimpleNamespace(now=Time),  # type: ignore[arg-type]
        SimpleNamespace(put=rows.append),  # type: ignore[arg-type]
        structlog.stdlib.get_logger("test"),
        SimpleNamespace(request=SimpleNamespace(resume=resume), publish=lambda _: None),  # type: ignore[arg-type]
        Facts("run", 1, 1, "", ["zx200"], Time()),
        record,
        lambda: None,
    )


@pytest.fixture
def a_run(rows: list[Any]) -> Run:
    return new_run(rows, SimpleNamespace(event=lambda _: None, over=lambda *_: None, remove=lambda: None))


def parts(rows: list[Any], **own: Any) -> Any:
    """What an execution needs, in which every run meets a bug as soon as it reads its task."""
    ros = SimpleNamespace(now=Time)
    log = structlog.stdlib.get_logger("test")
    app = SimpleNamespace(ros=ros, log=log, process=SimpleNamespace(full="tms:ts"))
    record = SimpleNamespace(event=lambda _: None, over=lambda *_: None, remove=lambda: None)
    there = {
        "app": app, "disk": SimpleNamespace(wait=lambda _: True), "journal": SimpleNamespace(put=rows.append),
        "records": SimpleNamespace(open=lambda _: record), "numbers": SimpleNamespace(next=lambda _: 1),
        "gateways": SimpleNamespace(drop=lambda _: None), "publisher": SimpleNamespace(changed=lambda: None),
        "check": SimpleNamespace(task=lambda _: broken()),
        "leases": SimpleNamespace(
            several=False, last=lambda: 0, give_back=lambda _: None, scheduler=SimpleNamespace(suffix="")
        ),
    }  # fmt: skip
    return SimpleNamespace(**{**there, **own})


def tree(tick: Callable[[], Status] = lambda: Status.RUNNING, halt: Callable[[], None] = lambda: None) -> Any:
    return SimpleNamespace(tick=tick, halt=halt, nodes=[], running=list, observers=[])


class Permits:
    """Those of the run's machines."""

    def __init__(self, back: Reason | None = None) -> None:
        self.back, self.told = back, list[str]()

    def hold(self) -> Reason | None:
        self.told.append("held")
        return self.back

    def drop(self) -> None:
        self.told.append("dropped")


def states(rows: list[Any]) -> list[str]:
    return [row.state for row in rows if hasattr(row, "state")]


@pytest.mark.parametrize("ended", [Status.SUCCESS, Status.FAILURE])
def test_a_bug_while_the_tree_is_halted_does_not_keep_the_machines_from_being_stopped(
    a_run: Run, ended: Status
) -> None:
    machines = Machines()
    with pytest.raises(RuntimeError, match="a bug"):
        a_run.execute(tree(lambda: ended, broken), machines, Permits())  # type: ignore[arg-type]
    assert machines.stopped == ["zx200"]


def test_a_bug_in_a_tick_does_not_keep_the_machines_from_being_stopped(a_run: Run) -> None:
    machines = Machines()
    with pytest.raises(RuntimeError, match="a bug"):
        a_run.execute(tree(broken), machines, Permits())  # type: ignore[arg-type,return-value]
    assert machines.stopped == ["zx200"]


def test_further_fields_of_a_run_get_into_the_history(a_run: Run, rows: list[Any]) -> None:
    a_run.facts.values["nodes"] = 3
    a_run.enter("running")
    assert from_parameters(rows[0].values) == {"nodes": 3}


def test_a_success_stops_nobody_and_drops_its_permits_at_the_end(a_run: Run, rows: list[Any]) -> None:
    machines, permits = Machines(), Permits()
    a_run.execute(tree(lambda: Status.SUCCESS), machines, permits)  # type: ignore[arg-type]
    assert (machines.stopped, permits.told) == ([], ["held", "dropped"])
    assert states(rows) == ["running", "success"] and a_run.over


def test_a_tree_that_succeeds_while_a_halted_leaf_still_moves_has_its_machine_seen_to_stop(
    a_run: Run, rows: list[Any]
) -> None:
    machines = Machines("/zx200/st_zx200_swing")
    a_run.nodes.failure = Foreign("an earlier leaf failed")
    a_run.execute(tree(lambda: Status.SUCCESS), machines, Permits())  # type: ignore[arg-type]
    assert machines.stopped == ["zx200"]
    assert states(rows) == ["running", "stopping", "success"] and a_run.facts.reason is None


def test_a_machine_that_was_not_seen_to_stand_is_told(a_run: Run, rows: list[Any]) -> None:
    machines = Machines("/zx200/st_zx200_swing", confirmed=False)
    a_run.execute(tree(lambda: Status.SUCCESS), machines, Permits())  # type: ignore[arg-type]
    assert states(rows)[-1] == "stop_unconfirmed"
    assert a_run.facts.reason is not None and a_run.facts.reason.find(StopUnconfirmed) is not None
    assert [row.kind for row in rows if getattr(row, "kind", "") == "alarm"] == ["alarm"]


def test_a_machine_that_was_stopped_before_its_permit_was_held_refuses_the_run(a_run: Run, rows: list[Any]) -> None:
    machines, permits = Machines(), Permits(Foreign("latched"))
    a_run.execute(tree(broken), machines, permits)  # type: ignore[arg-type,return-value]
    assert states(rows) == ["refused"] and a_run.refused == Foreign("latched")
    assert (machines.stopped, permits.told) == ([], ["held", "dropped"])


def test_a_run_that_is_cancelled_halts_its_tree_first(a_run: Run, rows: list[Any]) -> None:
    machines, done = Machines(), list[str]()
    monkey = lambda: done.append("halted") or done.extend(machines.stopped)  # noqa: E731
    a_run.cancel("cancelled", Foreign("enough"))
    a_run.execute(tree(broken, monkey), machines, Permits())  # type: ignore[arg-type,return-value]
    assert (done, machines.stopped) == (["halted"], ["zx200"])
    assert states(rows) == ["running", "stopping", "cancelled"] and a_run.facts.reason == Foreign("enough")


def test_the_loop_never_sleeps_longer_than_its_period_after_many_wakes(
    a_run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Feedback of three machines for three seconds, then silence: the permits need a tick again at once."""
    now, wakes, waits = [0.0], [0.03] * 100, list[float]()

    def wait(seconds: float) -> None:
        waits.append(seconds)
        now[0] += min(seconds, wakes.pop() if wakes else seconds)
        if len(waits) == 110:
            a_run.cancel()

    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    monkeypatch.setattr(a_run, "wake", SimpleNamespace(wait=wait, clear=lambda: None, set=lambda: None))
    a_run.execute(tree(), Machines(), Permits())  # type: ignore[arg-type]
    assert max(waits) == pytest.approx(TICK_PERIOD)
    assert len(waits) >= 110


def test_a_run_rests_after_each_client_and_looks_at_a_calm_pace(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each process of the site hears of a new client; goals at work elsewhere need the processors for their beats."""
    now, rests, looks = [0.0], list[float](), [False, False, True]

    def peer(machine: str, subtask: str) -> object:
        now[0] += 0.05
        return SimpleNamespace(ready=lambda: machine == "r1" or looks.pop(0))

    hosts = SimpleNamespace(wait_known=lambda seconds: None, start=lambda names, cancelled: None)
    run = SimpleNamespace(cancelled=SimpleNamespace(is_set=lambda: False, wait=rests.append))
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    execution = Execution(parts([], hosts=hosts))
    execution._prepare(run, ["r1:boom", "r2:boom"], SimpleNamespace(peer=peer))  # type: ignore[arg-type]
    assert rests == pytest.approx([0.1, 0.1, 0.02, 0.02])


def test_a_run_that_meets_a_bug_is_closed_in_the_history(rows: list[Any]) -> None:
    runs = ActiveRuns()
    execution = Execution(parts(rows, runs=runs))
    goal = SimpleNamespace(
        request=SimpleNamespace(resume="", task_id=1),
        publish=lambda _: None,
        cancelled=SimpleNamespace(is_set=lambda: False),
    )
    with pytest.raises(RuntimeError, match="a bug"):
        execution.execute(goal)  # type: ignore[arg-type]
    reported = [row for row in rows if hasattr(row, "state")]
    assert reported[-1].state == "refused" and "INTERNAL" in reported[-1].reason
    assert list(runs) == []


def test_a_resume_that_is_refused_leaves_its_record_and_no_open_file(rows: list[Any], tmp_path: Path) -> None:
    disk = GroupCommit(structlog.stdlib.get_logger("disk"))

    def files() -> int:
        return len(list(Path("/proc/self/fd").iterdir()))

    before = files()
    record = Records(tmp_path, disk).open("run")
    resumed = new_run(rows, record, resume="run")
    resumed.refuse(MachineLatched("zx200", SoftwareStop()))
    disk.close(10)
    assert files() == before
    assert read(record.path).closed


def test_a_loop_that_waits_is_told_to_whoever_looks_and_in_part_to_the_history(a_run: Run, rows: list[Any]) -> None:
    node: Any = SimpleNamespace(name="wait", path="0.1", uid=2, parent=None, registration_name="Wait", reason=None)
    assert a_run.nodes.feedback(tree())  # the first message has every node, later ones have changes
    for _ in range(MAX_BURST + 300):
        a_run.nodes.begin_tick()
        a_run.nodes.changed(node, Status.RUNNING, Status.SUCCESS)
        a_run.nodes.report_flood()
    reported = [row.text for row in rows if row.kind == "node" and row.node]
    assert MAX_BURST <= len(reported) < MAX_BURST + 10
    assert [row.text for row in rows if row.kind == "node" and not row.node] == [to_line(LeftOut(1))]
    message = a_run.nodes.feedback(tree(), last=True)
    assert message is not None and len(message.nodes) == MAX_BURST + 300
    a_run.execute(tree(lambda: Status.SUCCESS), Machines(), Permits())  # type: ignore[arg-type]
    reported_at_end = [row.text for row in rows if hasattr(row, "kind") and row.kind == "node" and not row.node][1:]
    assert len(reported_at_end) == 1 and wire.known(reported_at_end[0]).args["count"] > 280


@pytest.mark.parametrize(("stored", "reported"), [(True, "it rains"), (False, "it rains (not stored yet: the disk")])
def test_a_result_is_told_when_its_run_s_end_is_stored_or_with_a_note(
    stored: bool, reported: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[float] = []
    ended = (Outcome.ABORTED, ExecuteTask.Result(run_id="run", outcome="failure", error_msg="it rains"))
    execution = Execution(parts([], disk=SimpleNamespace(wait=lambda seconds: asked.append(seconds) or stored)))
    monkeypatch.setattr(execution, "_run", lambda goal, past: ended)
    how, result = execution.execute(SimpleNamespace(request=SimpleNamespace(resume="")))  # type: ignore[arg-type]
    assert (how, asked) == (Outcome.ABORTED, [END_STORED])
    said = words(result.error_msg)
    assert said.startswith(reported) and stored == (said == reported)
