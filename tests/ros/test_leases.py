"""A subscription learns whether a publisher is asserted, also where DDS does not tell."""

import threading
from typing import Any

import pytest
from tms_msg_rc.msg import Permit as Message

from tms_decision.permit_link import LEASE
from tms_ros.node import Ros
from tms_runtime import leases
from tms_runtime.pulse import Pulse

pytestmark = pytest.mark.ros
TOPIC, LIMIT = "/zx200/permit/rc", 20.0


class Reader:
    """What one subscription knows."""

    def __init__(self, ros: Ros) -> None:
        self.changed, self.numbers, self.received = threading.Condition(), (0, 0), 0
        ros.on_executor(lambda: leases.subscribe(ros, Message, TOPIC, LEASE, self._on_message, self._on_liveliness))

    def _on_message(self, _message: Any) -> None:
        with self.changed:
            self.received += 1
            self.changed.notify_all()

    def _on_liveliness(self, *numbers: int) -> None:
        with self.changed:
            self.numbers = numbers
            self.changed.notify_all()

    def wait(self, *numbers: int) -> None:
        with self.changed:
            assert self.changed.wait_for(lambda: self.numbers == numbers, LIMIT), f"{self.numbers}, not {numbers}"


def test_a_reader_that_comes_second_knows_that_a_publisher_lives(two_nodes: tuple[Ros, Ros]) -> None:
    """The first one of its process has been told, and Fast DDS does not tell it again."""
    server, client = two_nodes
    publisher = server.lease_publisher(Message, TOPIC, LEASE)
    beat, pulse = publisher.assert_liveliness, Pulse(server)
    publisher.publish(Message(process="rc", goal=[1] * 16))
    pulse.add(beat)
    readers = [Reader(client)]
    readers[0].wait(1, 0)
    readers.append(Reader(client))
    readers[1].wait(1, 0)
    assert readers[1].received == 1
    pulse.remove(beat)
    for reader in readers:
        reader.wait(0, 1)
    pulse.add(beat)
    for reader in readers:
        reader.wait(1, 0)
