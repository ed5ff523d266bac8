"""A run is sent once more only where the scheduler that has answered does not know it."""

from typing import Any

import pytest
from tms_msg_ts.action import ExecuteTask

from tms_ros.client import Call
from tms_ros.goals import Outcome
from tms_schedulers import sending

GOAL = ExecuteTask.Goal(task_id=1)


class Scheduler:
    """Answers each goal that it gets as the test says: at once, when asked what became of it, or never."""

    def __init__(self, *answers: str) -> None:
        self._answers = list(answers)
        self.calls: list[Call[Any, Any]] = []
        self.waited = 0

    def wait_ready(self, seconds: float) -> None:
        self.waited += 1

    def send(self, goal: ExecuteTask.Goal) -> Call[Any, Any]:
        assert goal is GOAL
        call: Call[Any, Any] = Call(bytes([len(self.calls)]), None, None)
        call.accepted = self._answers[len(self.calls)] == "accepts"
        if self._answers[len(self.calls)] == "rejects":
            call.end(Outcome.REJECTED)
        self.calls.append(call)
        return call

    def resolve_unanswered(self, call: Call[Any, Any]) -> None:
        known = {"does not know it": Outcome.LOST, "had taken it": Outcome.CANCELED}
        if (outcome := known.get(self._answers[len(self.calls) - 1])) is not None:
            call.end(outcome)


@pytest.mark.parametrize(
    ("answers", "outcome"),
    [
        (["accepts"], None),
        (["rejects"], Outcome.REJECTED),
        (["does not know it", "accepts"], None),
        (["had taken it"], Outcome.CANCELED),
        (["says nothing"], None),
    ],
)
def test_a_goal_that_got_lost_with_a_scheduler_goes_to_its_successor(
    answers: list[str], outcome: Outcome | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sending, "DISCOVERY_LEASE", 0.01)
    monkeypatch.setattr(sending, "LIMIT", 0.01)
    scheduler: Any = Scheduler(*answers)
    call = sending.send(scheduler, GOAL)
    assert scheduler.calls[-1] is call and len(scheduler.calls) == scheduler.waited == len(answers)
    assert call.outcome is outcome and call.accepted == (answers[-1] == "accepts")
