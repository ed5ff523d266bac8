"""The connection of the stand-in of OperaSim-PhysX, against a scripted endpoint; its clock is that of the test."""

import random
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from conftest import wait_until
from fake_endpoint import FakeEndpoint, endpoint_frame, handshake
from operasim.connection import Connection
from operasim.framing import FrameError, Splitter, frame
from operasim.outbox import Outbox
from operasim.registration import Registration

LIMIT = 10.0  # s
ODOM = Registration("zx200/odom", "nav_msgs/Odometry", True)
TWIST = Registration("zx200/tracks/cmd_vel", "geometry_msgs/Twist", False)


class Wire:
    """A connection and its endpoint, at a time that the test sets."""

    def __init__(self) -> None:
        self.now = 100.0
        self.events: list[tuple[str, dict[str, Any]]] = []
        self.endpoint = FakeEndpoint()
        self.connection = Connection(self.endpoint.address, random.Random(0), self._event)

    def until(self, holds: Callable[[], bool], what: str) -> None:
        def done() -> bool:
            self.work()
            return holds()

        wait_until(done, LIMIT, lambda: f"{what}; {self.events} {self.endpoint.frames[-3:]}", every=0.001)

    def work(self) -> None:
        self.connection.work(self.now)
        self.endpoint.look()

    def connect(self, times: int = 1) -> None:
        self.until(lambda: self.endpoint.connections == times, "a connection")
        self.until(lambda: ("__topic_list", "") in self.endpoint.commands(), "the registrations")

    def greet(self) -> None:
        self.endpoint.say(handshake())
        self.until(lambda: self.connection.connected, "the handshake")

    def keep_alives(self, count: int) -> None:
        self.until(lambda: self.endpoint.keep_alives() == count, f"{count} keep-alives")

    def told(self, name: str) -> list[dict[str, Any]]:
        return [fields for one, fields in self.events if one == name]

    def _event(self, name: str, **fields: Any) -> None:
        self.events.append((name, fields))


@pytest.fixture
def wire() -> Iterator[Wire]:
    made = Wire()
    made.connection.register(ODOM)
    made.connection.register(TWIST)
    yield made
    made.connection.close("the test ends", made.now)
    made.endpoint.close()


def test_a_connection_begins_as_the_simulators(wire: Wire) -> None:
    wire.connect()
    assert wire.endpoint.frames[0] == (b"", b"")  # eight zero bytes
    assert wire.endpoint.commands() == [
        ("__publish", "zx200/odom"), ("__publish", "zx200/odom"), ("__subscribe", "zx200/tracks/cmd_vel"),
        ("__topic_list", ""),
    ]  # fmt: skip
    assert wire.endpoint.frames[1] == (
        b"__publish\0",
        b'{"topic": "zx200/odom", "message_name": "nav_msgs/Odometry", "queue_size": 10, "latch": false}\0',
    )


def test_it_sends_before_the_handshake(wire: Wire) -> None:
    wire.connect()
    wire.connection.send("zx200/odom", b"early")
    wire.until(lambda: wire.endpoint.messages("zx200/odom") == [b"early"], "the message")
    assert not wire.connection.connected
    wire.greet()
    assert wire.told("handshake") == [{"version": "v0.7.0", "protocol": "ROS2"}]


@pytest.mark.parametrize(
    "first",
    [
        handshake(version="v0.6.0"), handshake(protocol="ROS1"), handshake(name="__log"),
        endpoint_frame("__handshake", b"{broken"), endpoint_frame("__handshake", b"[]"), b"\xff" * 8,
    ],
    ids=["older", "ROS 1", "no handshake", "no JSON", "no object", "no frame"],
)  # fmt: skip
def test_anything_but_the_handshake_ends_it_and_it_tries_again_a_second_later(wire: Wire, first: bytes) -> None:
    wire.connect()
    wire.endpoint.say(first)
    wire.until(lambda: len(wire.told("disconnected")) == 1, "an end")
    wire.until(lambda: wire.endpoint.client is None, "the endpoint sees it")
    wire.now += 0.99
    wire.work()
    assert wire.connection.waits_for() == ([], [])
    wire.now += 0.02
    wire.connect(times=2)
    wire.greet()


def test_it_keeps_a_quiet_connection_alive(wire: Wire) -> None:
    wire.connect()
    assert wire.endpoint.keep_alives() == 1
    for count in (2, 3):
        wire.now += 0.9
        wire.work()
        assert wire.endpoint.keep_alives() == count - 1
        wire.now += 0.2
        wire.keep_alives(count)
    wire.now += 0.9
    wire.connection.send("zx200/odom", b"one")
    wire.until(lambda: bool(wire.endpoint.messages("zx200/odom")), "a message")
    wire.now += 0.9
    wire.work()
    assert wire.endpoint.keep_alives() == 3  # the message was one


def test_after_a_loss_all_is_registered_again_once(wire: Wire) -> None:
    wire.connect()
    wire.greet()
    late = Registration("zx200/boom/cmd", "std_msgs/Float64", False)
    wire.connection.register(late)
    wire.until(lambda: ("__subscribe", "zx200/boom/cmd") in wire.endpoint.commands(), "the late one")
    wire.endpoint.drop()
    wire.until(lambda: not wire.connection.connected, "the loss")
    wire.endpoint.frames.clear()
    wire.connection.send("zx200/odom", b"lost")
    wire.now += 1.01
    wire.connect(times=2)
    assert wire.endpoint.commands() == [
        ("__publish", "zx200/odom"), ("__subscribe", "zx200/tracks/cmd_vel"), ("__subscribe", "zx200/boom/cmd"),
        ("__topic_list", ""),
    ]  # fmt: skip
    assert wire.endpoint.messages("zx200/odom") == []


def test_messages_come_with_the_delay_of_the_reader_and_in_order(wire: Wire) -> None:
    wire.connect()
    wire.greet()
    for i in range(20):
        wire.endpoint.say(endpoint_frame("zx200/tracks/cmd_vel", bytes([i])))
        wire.work()
    got: list[bytes] = []

    def all_there() -> bool:
        got.extend(payload for _, payload in wire.connection.heard(wire.now + 0.0101))
        return len(got) == 20

    wire.until(all_there, "twenty messages")
    assert got == [bytes([i]) for i in range(20)]
    wire.endpoint.say(endpoint_frame("zx200/tracks/cmd_vel", b"x"))
    wire.until(lambda: bool(wire.connection._inbox), "one more")
    assert wire.connection.heard(wire.now) == []


def test_what_the_endpoint_says_is_logged(wire: Wire) -> None:
    wire.connect()
    wire.greet()
    wire.endpoint.say(endpoint_frame("__error", b'{"text": "no such topic"}') + endpoint_frame("__topic_list", b"{}"))
    wire.until(lambda: bool(wire.told("endpoint_says")), "what it says")
    assert wire.told("endpoint_says") == [{"level": "error", "text": "no such topic"}]


def failed(wire: Wire) -> bool:
    wire.connection.work(wire.now)
    return wire.connection.waits_for() == ([], [])


def test_an_endpoint_that_is_not_there_is_told_once(wire: Wire) -> None:
    wire.endpoint.server.close()
    for _ in range(3):
        wire.connection.work(wire.now)
        wait_until(lambda: failed(wire), LIMIT, "a failure", every=0.001)
        wire.now += 1.01
    assert [fields["reason"] for fields in wire.told("not_connected")] == ["ECONNREFUSED"]


def test_a_slow_endpoint_gets_the_newest_ten_of_each_topic(wire: Wire) -> None:
    wire.connect()
    wire.greet()
    big = bytes(200_000)
    for i in range(100):  # far more than sockets hold
        wire.connection.send("zx200/odom", i.to_bytes(4, "little") + big)
        wire.connection.work(wire.now)
    wire.until(
        lambda: any(one.startswith((99).to_bytes(4, "little")) for one in wire.endpoint.messages("zx200/odom")),
        "the last",
    )
    numbers = [int.from_bytes(one[:4], "little") for one in wire.endpoint.messages("zx200/odom")]
    assert numbers[-10:] == list(range(90, 100))
    assert numbers == sorted(set(numbers))
    assert len(numbers) < 100


def test_turns_of_dropped_messages_are_void() -> None:
    box = Outbox()
    for i in range(12):
        box.message("a", bytes([i]))
    box.message("b", b"b")
    assert box.dropped == 2
    taken = [box.take() for _ in range(12)]
    assert taken == [*(frame("a", bytes([i])) for i in range(2, 12)), frame("b", b"b"), None]


def test_frames_come_in_any_pieces() -> None:
    data = bytes(8) + endpoint_frame("a/b", b"123") + endpoint_frame("__log", b"")
    splitter = Splitter()
    found = [one for i in range(len(data)) for one in splitter.feed(data[i : i + 1])]
    assert found == [("a/b", b"123"), ("__log", b"")]
    with pytest.raises(FrameError):
        splitter.feed(b"\xff" * 4)
