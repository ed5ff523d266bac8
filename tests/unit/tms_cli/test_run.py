"""`tms run`: exit codes, refusals, Ctrl-C, the lost scheduler, and the JSON document."""

import json
from collections.abc import Callable
from typing import Any

import click
import pytest
from builtin_interfaces.msg import Time
from tms_msg_db.msg import Run, Task, Template
from tms_msg_db.srv import GetTask, GetTemplate, ListRuns
from tms_msg_ts.action import ExecuteTask
from tms_msg_ts.msg import NodeStatus, RunState, RunStates
from tms_msg_ts.srv import CancelRun

from tms_cli.commands import run
from tms_reason.errors import DbError, RosError
from tms_reason.reason import Foreign
from tms_reason.wire import to_line
from tms_ros.goals import Outcome
from tms_runtime.reasons import NotStored
from tms_ts.bt.expand import no_templates

XML = '<root><BehaviorTree ID="T"><AlwaysSuccess/></BehaviorTree></root>'


class FakeScheduler:
    """The action server and the goal in one: plays a list of feedbacks, then gives the result."""

    def __init__(self, *feedback: Any, outcome: Outcome | None = None, result: Any = None) -> None:
        self.feedback, self.end, self._result = feedback, outcome, result
        self.outcome: Outcome | None = None
        self.result: Any = None
        self.cancelled = False
        self.goal: Any = None
        self.asked_again = False

    def wait_ready(self, seconds: float) -> None:
        return

    def ask_again(self, call: Any) -> None:
        self.asked_again = True

    def send(self, goal: Any, on_feedback: Callable[[Any], None]) -> "FakeScheduler":
        self.goal = goal
        for message in self.feedback:
            on_feedback(message)
        if self.end is not None:
            self.finish(self.end, self._result)
        return self

    def wait_for(self, holds: Callable[[], bool], seconds: float) -> bool:
        return True  # it has taken the goal

    def finish(self, outcome: Outcome, result: Any) -> None:
        self.outcome, self.result = outcome, result

    def cancel(self, call: Any) -> None:
        self.cancelled = True
        self.finish(Outcome.CANCELED, result("cancelled", "CANCELLED"))


def feedback(status: int = 1) -> ExecuteTask.Feedback:
    nodes = [NodeStatus(uid=1, name="AlwaysSuccess", type="AlwaysSuccess", status=status)]
    return ExecuteTask.Feedback(run_id="r1", state="running", nodes=nodes)


def result(outcome: str, code: str = "", text: str = "") -> ExecuteTask.Result:
    return ExecuteTask.Result(run_id="r1", outcome=outcome, error_code=code, error_msg=text)


@pytest.fixture
def task(mesh) -> Any:
    mesh.answers["/tms/db/get_task"] = GetTask.Response(task=Task(task_id=1, description="d", task_sequence=XML))
    return mesh


def test_success_is_exit_code_0_and_shows_the_history(task, tms) -> None:
    task.action = FakeScheduler(feedback(), feedback(2), outcome=Outcome.SUCCEEDED, result=result("success"))
    end = tms(run.command, "1", "--wait")
    assert end.exit_code == 0, end.output
    assert "success  AlwaysSuccess" in end.stdout
    assert "tms events r1" in end.stdout
    assert task.action.goal.ignore_warnings is False


@pytest.mark.parametrize("outcome", ["failure", "refused", "stop_unconfirmed", "cancelled"])
def test_other_outcomes_are_exit_code_1_with_one_line(task, tms, outcome: str) -> None:
    task.action = FakeScheduler(feedback(), outcome=Outcome.ABORTED, result=result(outcome, "CODE", "because"))
    end = tms(run.command, "1", "--wait")
    assert end.exit_code == 1
    (line,) = end.stderr.splitlines()
    assert line.startswith("tms: ")
    assert "because" in line or outcome == "cancelled"


@pytest.mark.parametrize(("outcome", "said"), [("success", 1), ("cancelled", 1), ("failure", 0)])
def test_a_result_that_is_not_stored_yet_says_so(task, tms, outcome: str, said: int) -> None:
    task.action = FakeScheduler(
        feedback(), outcome=Outcome.ABORTED, result=result(outcome, "", to_line(NotStored(Foreign("why"))))
    )
    end = tms(run.command, "1", "--wait")
    assert end.stderr.count("tms: the end of r1 is not stored yet") == said
    assert "not stored yet" in end.stderr


def test_json_is_one_document_and_progress_goes_to_stderr(task, tms) -> None:
    task.action = FakeScheduler(feedback(), outcome=Outcome.ABORTED, result=result("failure", "FAILED", "leaf failed"))
    end = tms(run.command, "1", "--wait", "--json")
    document = json.loads(end.stdout)
    assert {"run_id": "r1", "outcome": "failure", "error_code": "FAILED", "error_msg": "leaf failed"}.items() <= (
        document.items()
    )
    assert "running" in end.stderr


def test_without_wait_it_returns_when_the_run_has_begun(task, tms) -> None:
    task.action = FakeScheduler(feedback())
    end = tms(run.command, "1")
    assert end.exit_code == 0
    assert "run r1 has begun" in end.stdout


def test_without_wait_a_refusal_is_still_reported(task, tms) -> None:
    refused = result("refused", "PREFLIGHT", "line 3: no record zx200/a")
    task.action = FakeScheduler(outcome=Outcome.ABORTED, result=refused)
    end = tms(run.command, "1")
    assert end.exit_code == 1
    assert "line 3: no record zx200/a" in end.stderr


@pytest.mark.parametrize("how", [Outcome.REJECTED, Outcome.LOST])
def test_a_goal_that_was_not_taken_is_a_refusal(task, tms, how: Outcome) -> None:
    task.action = FakeScheduler(outcome=how)
    end = tms(run.command, "1", "--wait")
    assert end.exit_code == 1
    assert "tms logs tms:ts" in end.stderr


def test_an_unknown_task_is_told_before_anything_is_sent(mesh, tms) -> None:
    mesh.answers["/tms/db/get_task"] = DbError(Foreign("there is no task 9"), "TASK_MISSING")
    mesh.action = FakeScheduler()
    assert str(tms(run.command, "9").exception) == "there is no task 9"
    assert mesh.action.goal is None


@pytest.mark.parametrize("word", ["0", "-1", "x", "1.5"])
def test_a_wrong_number_is_wrong_usage(task, tms, word: str) -> None:
    assert tms(run.command, "--", word).exit_code == 2


class PressesCtrlC:
    """A display at which somebody presses Ctrl-C at the given calls of `show`."""

    def __init__(self, *at: int) -> None:
        self.at, self.calls = at, 0

    def __enter__(self) -> "PressesCtrlC":
        return self

    def __exit__(self, *_: object) -> None:
        return

    def show(self, view: Any, changed: Any) -> None:
        self.calls += 1
        if self.calls in self.at:
            raise KeyboardInterrupt


def test_ctrl_c_cancels_through_the_scheduler_and_waits_for_the_end(task, tms, monkeypatch) -> None:
    scheduler = task.action = FakeScheduler(feedback())

    def cancel(**_: Any) -> CancelRun.Response:
        scheduler.finish(Outcome.CANCELED, result("cancelled", "CANCELLED"))
        return CancelRun.Response()

    task.answers["/tms/cancel_run"] = cancel
    monkeypatch.setattr(run.live, "display", lambda _: PressesCtrlC(1))
    end = tms(run.command, "1", "--wait")
    assert end.exit_code == 130
    assert ("/tms/cancel_run", {"run_id": "r1"}) in task.asked
    assert "CANCELLED" in end.stdout
    assert not scheduler.cancelled


def test_ctrl_c_before_the_run_has_an_id_cancels_the_goal_itself(task, tms, monkeypatch) -> None:
    task.action = FakeScheduler()
    monkeypatch.setattr(run.live, "display", lambda _: PressesCtrlC(1))
    assert tms(run.command, "1", "--wait").exit_code == 130
    assert task.action.cancelled


def test_ctrl_c_gets_through_when_the_cancel_service_is_not_there(task, tms, monkeypatch) -> None:
    task.action = FakeScheduler(feedback())
    task.answers["/tms/cancel_run"] = RosError(Foreign("no answer"))
    monkeypatch.setattr(run.live, "display", lambda _: PressesCtrlC(1))
    assert tms(run.command, "1", "--wait").exit_code == 130
    assert task.action.cancelled


def test_a_second_ctrl_c_leaves(task, tms, monkeypatch) -> None:
    task.action = FakeScheduler(feedback())
    task.answers["/tms/cancel_run"] = CancelRun.Response()  # accepted, but the run does not end
    monkeypatch.setattr(run.live, "display", lambda _: PressesCtrlC(1, 2))
    end = tms(run.command, "1", "--wait")
    assert end.exit_code != 0
    assert isinstance(end.exception, SystemExit)


def listing(*runs: RunState) -> RunStates:
    return RunStates(runs=list(runs))


@pytest.mark.parametrize(
    ("silent", "forgotten", "lists", "says"),
    [
        (0.0, 9.0, [], "has said nothing"),
        (9.0, 0.0, [listing(), listing(RunState(run_id="r2", task_id=1))], "was restarted"),
    ],
)
def test_a_scheduler_that_was_killed_is_noticed(
    task, tms, monkeypatch, silent: float, forgotten: float, lists: list[RunStates], says: str
) -> None:
    monkeypatch.setattr(run, "SILENT", silent)
    monkeypatch.setattr(run, "FORGOTTEN", forgotten)
    monkeypatch.setattr(run, "CHECK_PERIOD", 0.001)
    task.action = FakeScheduler(feedback())
    task.answers["/tms/db/list_runs"] = ListRuns.Response(runs=[Run(run_id="r1", state="running")])

    class Display(PressesCtrlC):
        def show(self, view: Any, changed: Any) -> None:
            for message in lists:
                task.received["/tms/runs"](message)

    monkeypatch.setattr(run.live, "display", lambda _: Display())
    end = tms(run.command, "1", "--wait")
    assert says in str(end.exception)
    assert "r1" in str(end.exception)
    assert task.action.asked_again == (says == "was restarted")  # a lost reply gets a second chance first


def test_a_result_that_got_lost_is_told_from_the_history(task, tms, monkeypatch) -> None:
    monkeypatch.setattr(run, "FORGOTTEN", 0.0)
    monkeypatch.setattr(run, "CHECK_PERIOD", 0.001)
    task.action = FakeScheduler(feedback())
    ended = Run(run_id="r1", state="failure", reason="because", ended_at=Time(sec=1))
    task.answers["/tms/db/list_runs"] = ListRuns.Response(runs=[ended])

    class Display(PressesCtrlC):
        def show(self, view: Any, changed: Any) -> None:
            task.received["/tms/runs"](listing())

    monkeypatch.setattr(run.live, "display", lambda _: Display())
    end = tms(run.command, "1", "--wait")
    assert end.exit_code == 1
    assert "failure (FAILED): because" in end.stderr


def test_leaves_carry_what_they_ask_of_a_machine() -> None:
    xml = (
        '<root><BehaviorTree ID="T"><Sequence><Action ID="LeafNodeZx200" model_name="zx200" record_name="pose" '
        'subtask_name="change_pose"/></Sequence></BehaviorTree></root>'
    )
    assert run._goals(xml, no_templates) == [("Sequence", ""), ("LeafNodeZx200", "zx200 · change_pose · pose")]
    assert run._goals("<root>", no_templates) == []


def test_leaves_of_templates_and_their_machines_are_shown(mesh, tms) -> None:
    calls = '<root><BehaviorTree ID="T"><Action ID="ExecuteSubtask" subtask_name="Dig"/></BehaviorTree></root>'
    leaf = '<LeafNodeZx200 model_name="zx200" record_name="pose" subtask_name="change_pose"/>'
    text = f'<root><BehaviorTree ID="B">{leaf}</BehaviorTree></root>'
    mesh.answers["/tms/db/get_task"] = GetTask.Response(task=Task(task_id=1, task_sequence=calls))
    mesh.answers["/tms/db/get_template"] = GetTemplate.Response(stored=Template(task_sequence=text))
    with click.Context(click.Command("tms")):
        view = run._view(mesh, 1)
    assert view.goals == [("LeafNodeZx200", "zx200 · change_pose · pose")]
    assert "/zx200/rc/state" in mesh.received
