"""What the gateway is told of presses of a machine's own stop, on real topics."""

from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from std_msgs.msg import Bool

from conftest import wait_until
from tms_config.models import Border
from tms_decision.gateway.events import Event, Pressed, StoodIn
from tms_machine.border import stood_in
from tms_rc.people import People
from tms_ros.node import Ros

pytestmark = pytest.mark.ros
TOPIC = "/zx200/emg_stop"


class Shell:
    """Keeps what happens."""

    def __init__(self) -> None:
        self.events: list[Event] = []

    def does(self, _kind: Any, _doer: Any) -> None:
        """Nothing is done here."""

    def happened(self, event: Event) -> None:
        self.events.append(event)


def people(ros: Ros) -> Shell:
    shell: Any = Shell()
    app: Any = SimpleNamespace(ros=ros, machine="zx200")
    People(app, shell, Border(emg_stop="emg_stop"))
    return shell  # type: ignore[no-any-return]


@pytest.mark.parametrize(("age", "believed"), [(1, True), (60, False)], ids=["its word", "an old word"])
def test_the_host_agents_word_before_a_gateway_was_there_counts(
    two_nodes: tuple[Ros, Ros], age: int, believed: bool
) -> None:
    host, ros = two_nodes
    word, press = host.publisher(Time, stood_in("zx200"), 1, latched=True), host.publisher(Bool, TOPIC)
    word.publish(Time(sec=host.now().sec - age))
    shell = people(ros)

    def heard() -> bool:
        if Pressed() not in shell.events:
            press.publish(Bool(data=True))
        return Pressed() in shell.events and (not believed or StoodIn() in shell.events)

    wait_until(heard, 30, "a press, and the word of the host agent")
    assert (StoodIn() in shell.events) is believed
    host.node.destroy_publisher(word)


def test_a_release_is_no_press(two_nodes: tuple[Ros, Ros]) -> None:
    host, ros = two_nodes
    press, shell = host.publisher(Bool, TOPIC), people(ros)
    wait_until(lambda: press.get_subscription_count() > 0, 30, "the topic is heard")
    press.publish(Bool(data=False))
    press.publish(Bool(data=True))
    wait_until(lambda: bool(shell.events), 30, "the press")
    assert shell.events == [Pressed()]
