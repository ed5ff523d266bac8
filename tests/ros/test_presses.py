"""Whose press of a machine's own stop it was, on real topics."""

import threading
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from std_msgs.msg import Bool

from conftest import wait_until
from tms_machine.border import stood_in
from tms_rc import presses
from tms_rc.active import StopKind
from tms_rc.presses import Presses
from tms_ros.node import Ros

pytestmark = pytest.mark.ros
TOPIC = "/zx200/emg_stop"


class Gateway:
    """What `Presses` needs of a gateway; a stop that it does not want latches, as the real one does."""

    def __init__(self, ros: Ros) -> None:
        self.stops: list[StopKind] = []
        self.stood_in = False
        self.press_known = threading.Event()
        self.latch = SimpleNamespace(cause="")
        self.received = self.judged = 0
        app: Any = SimpleNamespace(ros=ros, machine="zx200")
        guard: Any = self
        self._presses = Presses(app, guard, TOPIC)
        ros.subscribe(Bool, TOPIC, self._press, depth=10)
        self._ros = ros

    def _press(self, _: Any) -> None:
        self.received += 1
        self._ros.after(presses.YOUNG_DOUBT + 0.2, self._reported)

    def _reported(self) -> None:
        self.judged += 1

    def stop_now(self, cause: str, kind: StopKind) -> None:
        self.stops.append(kind)
        self.latch.cause = cause


@pytest.mark.parametrize(("age", "expected"), [(1, []), (60, [StopKind.LATCH])], ids=["its word", "an old word"])
def test_the_host_agents_word_before_a_gateway_was_there_counts(
    two_nodes: tuple[Ros, Ros], age: int, expected: list[StopKind]
) -> None:
    host, ros = two_nodes
    word, press = host.publisher(Time, stood_in("zx200"), 1, latched=True), host.publisher(Bool, TOPIC)
    word.publish(Time(sec=host.now().sec - age))
    gateway = Gateway(ros)

    def judged() -> bool:
        if not gateway.received:
            press.publish(Bool(data=True))
        return gateway.judged > 0

    wait_until(judged, 30, "a press is judged")
    assert gateway.stops == expected
    assert gateway.stood_in is (not expected)
    assert gateway.press_known.is_set()
    host.node.destroy_publisher(word)


def test_a_press_without_a_word_latches_and_a_release_does_not(two_nodes: tuple[Ros, Ros]) -> None:
    host, ros = two_nodes
    press, gateway = host.publisher(Bool, TOPIC), Gateway(ros)
    wait_until(lambda: gateway.received > 0 or press.publish(Bool(data=False)), 30, "the topic is heard")
    assert not gateway.stops
    gateway.press_known.set()
    press.publish(Bool(data=True))
    wait_until(lambda: not gateway.press_known.is_set(), 30, "no goal leaves while it is in doubt")
    assert not gateway.stops
    press.publish(Bool(data=False))
    wait_until(lambda: bool(gateway.stops), 30, "the press is judged")
    assert gateway.stops == [StopKind.LATCH]
    assert gateway.press_known.is_set()
