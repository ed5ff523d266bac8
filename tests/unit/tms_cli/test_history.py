"""`tms runs`, `tms events`, `tms cancel`: which run is meant, and how its history is shown."""

import json
from typing import Any

import click
import pytest
from builtin_interfaces.msg import Time
from tms_msg_db.msg import Event, Run
from tms_msg_db.srv import ListEvents, ListRuns
from tms_msg_ts.msg import RunState, RunStates
from tms_msg_ts.srv import CancelRun, ResumePlan

from tms_cli import session
from tms_cli.commands import abandon, cancel, events, resume, runs
from tms_cli.reasons import SchedulerSilent
from tms_machine.values import to_parameters
from tms_reason.errors import RosError, TmsError
from tms_reason.reason import Foreign


def made(run_id: str, state: str = "success", seconds: int | None = 4) -> Run:
    ended = Time() if seconds is None else Time(sec=100 + seconds)
    return Run(run_id=run_id, task_id=1, description="d", state=state, started_at=Time(sec=100), ended_at=ended)


NEWEST, OLDER = made("20260102-b"), made("20260101-a", "failure")


@pytest.mark.parametrize(
    ("word", "found"), [("last", NEWEST), ("20260101", OLDER), ("20260102-b", NEWEST), ("20260101-a", OLDER)]
)
def test_a_run_may_be_shortened(word: str, found: Run) -> None:
    assert runs.find_run([NEWEST, OLDER], word) is found


def test_a_full_id_wins_over_longer_ones() -> None:
    assert runs.find_run([made("ab"), made("a")], "a").run_id == "a"


def test_an_unknown_or_unclear_run_is_an_error() -> None:
    with pytest.raises(TmsError, match="there is no run 'x'"):
        runs.find_run([NEWEST], "x")
    with pytest.raises(TmsError, match="there is no run 'last'"):
        runs.find_run([], "last")
    with pytest.raises(TmsError, match="fits 2 runs"):
        runs.find_run([NEWEST, OLDER], "2026")


def test_runs_for_machines(mesh, tms) -> None:
    mesh.answers["/tms/db/list_runs"] = ListRuns.Response(runs=[NEWEST])
    (one,) = json.loads(tms(runs.command, "--limit", "1", "--json").stdout)
    assert one["run_id"] == "20260102-b"
    assert one["seconds"] == 4.0
    assert one["machines"] == []
    assert mesh.asked[0][1] == {"limit": 1}


def test_further_fields_of_a_run_are_told_without_being_known_here(mesh, tms) -> None:
    run = made("r1")
    run.values = to_parameters({"nodes": 3, "who": "mina"})
    mesh.answers["/tms/db/list_runs"] = ListRuns.Response(runs=[run])
    (one,) = json.loads(tms(runs.command, "--json").stdout)
    assert one["values"] == {"nodes": 3, "who": "mina"}


def test_runs_for_people(mesh, tms) -> None:
    mesh.answers["/tms/db/list_runs"] = ListRuns.Response(runs=[NEWEST, OLDER])
    lines = tms(runs.command).stdout.splitlines()
    assert len(lines) == 3
    assert "failure" in lines[2]


def journal(count: int) -> Any:
    entries = [
        Event(run_id=NEWEST.run_id, number=n, kind="node", node="0.1", text="a -> b", values=to_parameters({"x": 1.5}))
        for n in range(1, count + 1)
    ]

    def answer(run_id: str, after: int, limit: int) -> ListEvents.Response:
        return ListEvents.Response(events=[entry for entry in entries if entry.number > after][:limit])

    return answer


def test_a_long_journal_is_read_page_by_page(mesh, tms) -> None:
    mesh.answers["/tms/db/list_runs"] = ListRuns.Response(runs=[NEWEST])
    mesh.answers["/tms/db/list_events"] = journal(2300)
    document = json.loads(tms(events.command, "last", "--json").stdout)
    assert [entry["number"] for entry in document] == list(range(1, 2301))
    assert document[0]["values"] == {"x": 1.5}


def test_follow_shows_all_and_returns_when_the_run_has_ended(mesh, tms) -> None:
    mesh.answers["/tms/db/list_runs"] = ListRuns.Response(runs=[NEWEST])
    mesh.answers["/tms/db/list_events"] = journal(3)
    end = tms(events.command, "last", "--follow")
    assert end.exit_code == 0
    assert len(end.stdout.splitlines()) == 3
    assert "0.1  a -> b  x=1.5" in end.stdout


@pytest.mark.parametrize("follow", [[], ["--follow"]])
def test_events_of_nodes_name_the_template_that_they_come_from(mesh, tms, follow: list[str]) -> None:
    shape = to_parameters({"paths": ["0", "0.0"], "templates": ["", "Dig:5"]})
    mesh.answers["/tms/db/list_runs"] = ListRuns.Response(runs=[NEWEST])
    entries = [
        Event(run_id=NEWEST.run_id, number=n, kind=kind, node=node, text="a -> b", values=shape if n == 1 else [])
        for n, kind, node in ((1, "tree", ""), (2, "node", "0"), (3, "node", "0.0"))
    ]
    mesh.answers["/tms/db/list_events"] = lambda after, **_: ListEvents.Response(events=entries[after:])
    lines = tms(events.command, "last", *follow).stdout.splitlines()
    assert lines[1].endswith("0  a -> b") and lines[2].endswith("0.0  (Dig:5)  a -> b")


def test_follow_is_no_single_document(mesh, tms) -> None:
    assert tms(events.command, "last", "--follow", "--json").exit_code == 2


def active(*begun: tuple[str, int]) -> dict[str, RunStates]:
    """Active runs and when each began [s], as the scheduler tells them."""
    return {"/tms/runs": RunStates(runs=[RunState(run_id=name, started_at=Time(sec=at)) for name, at in begun])}


@pytest.mark.parametrize(("state", "code"), [("cancelled", 0), ("stop_unconfirmed", 1), ("success", 1)])
def test_cancel_is_done_only_when_the_stop_was_seen(mesh, tms, state: str, code: int) -> None:
    answers = iter([made("r1", "running", None), made("r1", "stopping", None), made("r1", state)])
    mesh.told = active(("r1", 100))
    mesh.answers["/tms/db/list_runs"] = lambda limit: ListRuns.Response(runs=[next(answers)])
    mesh.answers["/tms/cancel_run"] = CancelRun.Response()
    end = tms(cancel.command, "last", "--json")
    assert end.exit_code == code
    assert json.loads(end.stdout)["state"] == state


@pytest.mark.parametrize("word", ["last", "r2"])
def test_cancel_last_means_the_newest_active_run(mesh, tms, word: str) -> None:
    mesh.told = active(("r1", 100), ("r2-b", 300), ("r3", 200))
    mesh.answers["/tms/db/list_runs"] = ListRuns.Response(runs=[NEWEST, made("r2-b", "cancelled")])
    mesh.answers["/tms/cancel_run"] = CancelRun.Response()
    assert tms(cancel.command, word).exit_code == 0
    assert ("/tms/cancel_run", {"run_id": "r2-b"}) in mesh.asked


def test_cancel_says_when_nothing_is_to_be_cancelled(mesh, tms) -> None:
    mesh.told = active()
    mesh.answers["/tms/db/list_runs"] = ListRuns.Response(runs=[NEWEST])
    assert "no run is active" in str(tms(cancel.command, "last").exception)
    assert "has ended already: success" in str(tms(cancel.command, "20260102").exception)


def test_cancel_says_when_the_scheduler_tells_nothing(mesh, tms, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(session, "CALL_LIMIT", 0.0)
    silent = tms(cancel.command, "last").exception
    assert isinstance(silent, RosError) and silent.reason == SchedulerSilent()
    mesh.answers["/tms/db/list_runs"] = ListRuns.Response(runs=[NEWEST])
    assert "has ended already: success" in str(tms(cancel.command, "20260102").exception)


def test_cancel_does_not_wait_for_the_database(mesh, tms, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is asked only for the end, and again if it gives no answer for a while."""
    answers = iter([RosError(Foreign("the store gave no answer"), "STORE_DOWN"), made("r1", "cancelled")])

    def list_runs(limit: int) -> Any:
        assert ("/tms/cancel_run", {"run_id": "r1"}) in mesh.asked
        answer = next(answers)
        return answer if isinstance(answer, TmsError) else ListRuns.Response(runs=[answer])

    mesh.told = active(("r1", 100))
    mesh.answers |= {"/tms/cancel_run": CancelRun.Response(), "/tms/db/list_runs": list_runs}
    assert tms(cancel.command, "last").exit_code == 0
    monkeypatch.setattr(cancel, "END_LIMIT", 0.1)
    mesh.answers["/tms/db/list_runs"] = RosError(Foreign("the store gave no answer"), "STORE_DOWN")
    end = tms(cancel.command, "r1")
    assert isinstance(end.exception, RosError), "its end cannot be confirmed, and that is said"


@pytest.mark.parametrize(
    "away", [RosError(Foreign("nobody there"), "NO_SERVER"), TmsError(Foreign("full"), "STORE_DOWN")]
)
def test_what_the_database_cannot_tell_is_left_to_the_scheduler(mesh, tms, away: TmsError) -> None:
    mesh.told = active()
    mesh.answers["/tms/db/list_runs"] = away
    mesh.answers["/tms/cancel_run"] = RosError(Foreign("there is no run r9"), "NO_RUN")
    end = tms(cancel.command, "r9")
    assert ("/tms/cancel_run", {"run_id": "r9"}) in mesh.asked and "there is no run r9" in str(end.exception)


def test_resume_last_and_abandon_last_mean_the_newest_interrupted_run(mesh, tms) -> None:
    past = [made("r4"), made("r3", "interrupted"), made("r2", "interrupted")]
    mesh.answers["/tms/db/list_runs"] = ListRuns.Response(runs=past)
    mesh.answers["/tms/resume_plan"] = ResumePlan.Response(task_id=7, done=["swing"])
    mesh.answers["/tms/abandon_run"] = CancelRun.Response()
    asked = tms(resume.command, "last")
    assert "run r3, task 7" in asked.stderr and "1 leaves have ended" in asked.stderr and asked.exit_code == 1
    assert "run r3 is abandoned" in tms(abandon.command, "last").stdout
    assert [fields for name, fields in mesh.asked if name != "/tms/db/list_runs"] == [{"run_id": "r3"}] * 2


@pytest.mark.parametrize("command", [resume.command, abandon.command])
def test_last_is_refused_where_no_run_is_interrupted(mesh, tms, command: click.Command) -> None:
    mesh.answers["/tms/db/list_runs"] = ListRuns.Response(runs=[NEWEST])
    assert "no run is interrupted" in str(tms(command, "last").exception)
