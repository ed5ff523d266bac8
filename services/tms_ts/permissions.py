"""Serves NextStepPermission: a machine's subtask, or a node of the C++ system, asks a person before it goes on."""

import threading
from collections.abc import Callable, Iterable

from tms_msg_ur.action import NextStepPermission

from tms_decision.owner import parse
from tms_kit.acting import REQUEST
from tms_reason.reason import Reason
from tms_ros.goals import Ended, Outcome
from tms_ros.server import Goal
from tms_runtime.app import App
from tms_ts.active_runs import ActiveRuns
from tms_ts.questions import Clicks, Questions

SUBTASK = "wait_for_ur"
PermissionGoal = Goal[NextStepPermission.Goal, NextStepPermission.Feedback]


class Permissions:
    """Puts a question for each goal: all clients show it, and the first answer counts, as for WaitForClick."""

    def __init__(self, runs: ActiveRuns, questions: Questions) -> None:
        self._runs, self._questions = runs, questions

    def serve(self, app: App, machines: Iterable[str]) -> None:
        """Serve the machines that have such a subtask: each action costs every process of the site."""
        for machine in sorted(machines):
            model = app.site.model_of(machine)
            if any(model.subtask(name).run == SUBTASK for name in model.subtasks):
                app.ros.serve(NextStepPermission, f"/{machine}/{REQUEST}", self.run)

    def run(self, goal: PermissionGoal) -> Ended[NextStepPermission.Result]:
        """Wait for the answer: yes succeeds, no aborts."""
        answered = threading.Event()
        goal.on_cancel = answered.set
        machine, _, question = goal.request.machinename.partition(",")
        run_id, log_event = self._asker(goal.uuid)
        clicks = Clicks(self._questions, run_id, answered.set, log_event)
        asked = clicks.ask(machine, question or machine, "", None)
        if not goal.cancelled.is_set():
            answered.wait()
        if not asked.done:
            clicks.withdraw(asked)
            return Outcome.CANCELED, NextStepPermission.Result()
        outcome = Outcome.SUCCEEDED if asked.value else Outcome.ABORTED
        return outcome, NextStepPermission.Result(success=asked.value)

    def _asker(self, goal: bytes) -> tuple[str, Callable[[str, str, Reason], None]]:
        """The run that a goal belongs to, and its history; a foreign goal has neither."""
        owner = parse(goal)
        run = next((one for one in self._runs if owner is not None and one.facts.number == owner.run), None)
        return ("", lambda *_: None) if run is None else (run.facts.run_id, run.log_event)
