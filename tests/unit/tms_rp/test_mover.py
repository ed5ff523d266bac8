"""What the end of a motion means to whoever asked for it."""

import threading
from types import SimpleNamespace
from typing import Any

import pytest

from tms_decision.reasons import ProcessLost
from tms_machine.reasons import Busy
from tms_reason import wire
from tms_reason.errors import SubtaskFailed
from tms_ros.goals import Outcome
from tms_rp import mover
from tms_rp.mover import Mover, _verdict
from tms_rp.trajectory import Trajectory, TrajectorySample


def verdict(outcome: Outcome, cancelled: bool, reported: str = "") -> Outcome:
    goal: Any = SimpleNamespace(cancelled=threading.Event())
    if cancelled:
        goal.cancelled.set()
    call: Any = SimpleNamespace(outcome=outcome, result=SimpleNamespace(error_string=reported))
    return _verdict(goal, call, "/zx200/rc/follow_joint_trajectory")


def test_a_cancelled_motion_that_ended_moves_nothing_any_more() -> None:
    for outcome in (Outcome.CANCELED, Outcome.SUCCEEDED, Outcome.REJECTED):
        assert verdict(outcome, cancelled=True) is Outcome.CANCELED
    assert verdict(Outcome.SUCCEEDED, cancelled=False) is Outcome.SUCCEEDED


@pytest.mark.parametrize("cancelled", [False, True])
def test_a_gateway_that_is_lost_has_seen_nobody_stand(cancelled: bool) -> None:
    with pytest.raises(SubtaskFailed) as caught:
        verdict(Outcome.LOST, cancelled)
    assert isinstance(caught.value.reason, ProcessLost)


def test_a_motion_that_was_aborted_says_why_also_after_a_cancel() -> None:
    with pytest.raises(SubtaskFailed) as caught:
        verdict(Outcome.ABORTED, cancelled=True, reported=wire.to_line(Busy("zx200:rc")))
    assert caught.value.reason.find(Busy) == Busy("zx200:rc")


class Gateway:
    """Accepts a goal, and moves until it is cancelled."""

    name = "/zx200/rc/follow_joint_trajectory"

    def __init__(self) -> None:
        self.cancels = 0
        self.call: Any = SimpleNamespace(accepted=True, outcome=None, result=None, changed=lambda: None)
        self.call.wait_for = lambda there, _: there()

    def wait_ready(self, _: float) -> None:
        pass

    def send(self, *_: Any, on_feedback: Any, **__: Any) -> Any:
        at = SimpleNamespace(sec=3, nanosec=500_000_000)
        on_feedback(SimpleNamespace(desired=SimpleNamespace(time_from_start=at)))
        return self.call

    def left(self) -> bool:
        return False

    def cancel(self, call: Any) -> None:
        self.cancels += 1
        call.outcome = Outcome.CANCELED


def test_what_comes_into_the_way_stops_the_motion(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mover, "derived", lambda _: None)
    gateway: Any = Gateway()
    goal: Any = SimpleNamespace(cancelled=threading.Event(), uuid=b"")
    still = (0.0,)
    made = Trajectory(("swing_joint",), tuple(TrajectorySample(t, still, still, still) for t in (0.0, 9.0)), (9.0,))
    asked: list[float] = []

    def blocked(seconds: float) -> Busy | None:
        asked.append(seconds)
        return Busy("ic120_1") if len(asked) == 3 else None

    with pytest.raises(SubtaskFailed) as caught:
        Mover(gateway).move(goal, made, lambda _: None, blocked)
    assert caught.value.reason == Busy("ic120_1") and gateway.cancels == 1
    assert asked == [3.5] * 3
