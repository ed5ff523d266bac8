"""Commands of a stop that a busy machine takes late would end a goal that was sent after it, or have it refused."""

from typing import Any

import pytest
from action_msgs.srv import CancelGoal
from rclpy.task import Future

from conftest import wait_until
from tms_config.models import Border
from tms_machine import border
from tms_machine.border import Controls
from tms_ros.node import Ros

pytestmark = pytest.mark.ros
LIMIT = 20.0  # s for whatever must happen at all


class Busy:
    """A machine's action server that takes cancels, and answers them when it is told to."""

    def __init__(self, ros: Ros) -> None:
        self.asked = 0
        self._ros, self._free = ros, Future()
        ros.offer(CancelGoal, "/zx200/turn/_action/cancel_goal", self._cancel)

    async def _cancel(self, _request: Any, answer: Any) -> Any:
        self.asked += 1
        await self._free
        return answer

    def answer(self) -> None:
        self._ros.on_executor(lambda: self._free.set_result(None))


@pytest.fixture
def busy(two_nodes: tuple[Ros, Ros]) -> Busy:
    return Busy(two_nodes[0])


@pytest.fixture
def controls(two_nodes: tuple[Ros, Ros], busy: Busy) -> Controls:
    made = Controls(two_nodes[1], "zx200", Border(set_swing_angle="turn", emg_stop="emg_stop"))
    wait_until(made.reachable, LIMIT, "the server is found")
    return made


def test_a_cancel_counts_until_the_server_has_answered(
    busy: Busy, controls: Controls, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(border, "CANCEL_LIMIT", 3 * LIMIT)
    assert not controls.settling()
    for count in (1, 2):  # a stop repeats its commands
        controls.cancel_everything()
        wait_until(lambda count=count: busy.asked == count, LIMIT, "the server has it")  # type: ignore[misc]
    assert controls.settling()
    busy.answer()
    wait_until(lambda: not controls.settling(), LIMIT, "both are answered")


def test_a_release_counts_for_a_while(controls: Controls, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(border, "RELEASE_LIMIT", 3 * LIMIT)
    controls.emergency(True)
    assert not controls.settling()
    controls.emergency(False)
    assert controls.settling()
    monkeypatch.setattr(border, "RELEASE_LIMIT", 0.0)
    assert not controls.settling()


def test_a_cancel_that_is_never_answered_counts_for_a_while(
    busy: Busy, controls: Controls, monkeypatch: pytest.MonkeyPatch
) -> None:
    controls.cancel_everything()
    wait_until(lambda: busy.asked == 1, LIMIT, "the server has it")
    assert controls.settling()
    monkeypatch.setattr(border, "CANCEL_LIMIT", 0.0)
    assert not controls.settling()
