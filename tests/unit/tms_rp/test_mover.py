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
from tms_rp.mover import _verdict


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
