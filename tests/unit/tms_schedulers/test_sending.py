"""A run is sent once more only where the scheduler that has answered does not know it."""

from typing import Any

import pytest
from tms_msg_ts.action import ExecuteTask

from tms_reason.errors import RosError
from tms_ros.client import Call
from tms_ros.goals import Outcome
from tms_schedulers import sending
from tms_schedulers.reasons import RunNotBegun

GOAL = ExecuteTask.Goal(task_id=1)
FEEDBACK: Any = object()


class Scheduler:
    """Answers each goal that it gets as the test says: at once, when asked what became of it, or never."""

    name = "/tms/ts/execute_task"

    def __init__(self, *answers: str) -> None:
        self._answers = list(answers)
        self.calls: list[Call[Any, Any]] = []
        self.waited = 0

    def wait_ready(self, seconds: float) -> None:
        self.waited += 1

    def send(self, goal: ExecuteTask.Goal, on_feedback: object) -> Call[Any, Any]:
        assert goal is GOAL and on_feedback is FEEDBACK
        call: Call[Any, Any] = Call(bytes([len(self.calls)]), None, None)
        call.accepted = self._answers[len(self.calls)] == "accepts"
        if self._answers[len(self.calls)] == "rejects":
            call.end(Outcome.REJECTED)
        self.calls.append(call)
        return call

    def cancel(self, call: Call[Any, Any]) -> None:
        call.end(Outcome.CANCELED)

    def resolve_unanswered(self, call: Call[Any, Any]) -> None:
        known = {
            "does not know it": Outcome.LOST, "had taken it": Outcome.CANCELED, "had refused it": Outcome.ABORTED,
        }  # fmt: skip
        if (outcome := known.get(self._answers[len(self.calls) - 1])) is not None:
            call.end(outcome)


def hurry(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sending, "DISCOVERY_LEASE", 0.01)
    monkeypatch.setattr(sending, "LIMIT", 0.01)


@pytest.mark.parametrize(
    ("answers", "outcome"),
    [
        (["accepts"], None),
        (["rejects"], Outcome.REJECTED),
        (["does not know it", "accepts"], None),
        (["had refused it"], Outcome.ABORTED),
        (["says nothing"], None),
    ],
)
def test_a_goal_that_got_lost_with_a_scheduler_goes_to_its_successor(
    answers: list[str], outcome: Outcome | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    hurry(monkeypatch)
    scheduler: Any = Scheduler(*answers)
    call = sending.send(scheduler, GOAL, FEEDBACK)
    assert scheduler.calls[-1] is call and len(scheduler.calls) == scheduler.waited == len(answers)
    assert call.outcome is outcome and call.accepted == (answers[-1] == "accepts")


def test_a_run_that_its_scheduler_has_taken_too_late_is_ended_and_not_taken_for_a_started_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    hurry(monkeypatch)
    scheduler: Any = Scheduler("had taken it")
    with pytest.raises(RosError) as error:
        sending.send(scheduler, GOAL, FEEDBACK)
    assert error.value.reason == RunNotBegun(0.01, "tms:ts")


def test_ctrl_c_before_the_answer_cancels_the_goal(monkeypatch: pytest.MonkeyPatch) -> None:
    waits: list[float] = []

    def interrupted(call: Call[Any, Any], holds: Any, seconds: float) -> bool:
        waits.append(seconds)
        if len(waits) == 1:
            raise KeyboardInterrupt
        return bool(holds())

    monkeypatch.setattr(Call, "wait_for", interrupted)
    scheduler: Any = Scheduler("says nothing")
    with pytest.raises(KeyboardInterrupt):
        sending.send(scheduler, GOAL, FEEDBACK)
    assert scheduler.calls[0].outcome is Outcome.CANCELED and waits == [sending.DISCOVERY_LEASE, sending.LIMIT]
