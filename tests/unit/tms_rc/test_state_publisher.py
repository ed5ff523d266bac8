"""When a gateway tells the state of its machine."""

import time
from types import SimpleNamespace
from typing import Any, cast

import pytest

from tms_rc.guard import Guard
from tms_rc.node import MOVING_PERIOD, STILL_PERIOD, StatePublisher
from tms_rc.standstill import StandStill


class Rig:
    """A gateway without a machine, and a clock that is moved by hand."""

    def __init__(self) -> None:
        self.now, self.reported, self.moving = 100.0, 0, False
        self.guard: Any = SimpleNamespace(
            active=None,
            latch=SimpleNamespace(cause="", hold=""),
            permits=SimpleNamespace(holder=lambda: ""),
            by_hand="",
        )
        watch = SimpleNamespace(moving=lambda: self.moving)
        self.state_publisher = StatePublisher(cast(Guard, self.guard), cast(StandStill, watch), self._publish)

    def _publish(self) -> None:
        self.reported += 1

    def after(self, seconds: float) -> int:
        """How often it is told at the next look."""
        self.now += seconds
        before = self.reported
        self.state_publisher.check()
        return self.reported - before


@pytest.fixture
def rig(monkeypatch: pytest.MonkeyPatch) -> Rig:
    made = Rig()
    monkeypatch.setattr(time, "monotonic", lambda: made.now)
    made.state_publisher.check()
    return made


def test_a_machine_that_stands_is_told_of_now_and_then(rig: Rig) -> None:
    assert [rig.after(0.6 * STILL_PERIOD) for _ in range(4)] == [0, 1, 0, 1]


def test_a_machine_that_moves_is_told_of_often(rig: Rig) -> None:
    rig.moving = True
    assert rig.after(0.01) == 1
    assert [rig.after(0.6 * MOVING_PERIOD) for _ in range(4)] == [0, 1, 0, 1]


def test_a_change_is_told_at_once(rig: Rig) -> None:
    rig.guard.latch.cause = "software stop"
    assert [rig.after(0.01) for _ in range(2)] == [1, 0]
    rig.guard.active = SimpleNamespace(goal=SimpleNamespace(id="17"))
    assert [rig.after(0.01) for _ in range(2)] == [1, 0]
