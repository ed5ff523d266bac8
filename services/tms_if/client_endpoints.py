"""The ROS side of one client: its publishers, subscriptions and services, which end with it."""

import itertools
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

from prometheus_client import Counter

from tms_config.clock import monotonic
from tms_if import joint_cmd
from tms_if.commands import CommandError, Registration, command, full_name
from tms_if.framing import encode
from tms_if.fresh_start import FreshStart
from tms_if.hearing import Hearing
from tms_if.interfaces import interface, short_name
from tms_if.names import Allowed
from tms_if.on_executor import do
from tms_machine import stamps
from tms_reason.errors import RosError
from tms_ros.node import Ros
from tms_ros.packing import pack, unpack

ROS_LIMIT = 5.0  # s for the ROS thread to make or remove something
ANSWER_LIMIT = 30.0  # s for a service to answer, on either side
OPEN_CALLS = 100  # calls that wait for an answer, on either side
FOLLOW_PERIOD = 0.5  # s between looks at who publishes what a client hears
REFUSED = 1000  # refused topics that are kept for one client

LEFT_OUT = Counter("tms_if_left_out_total", "Messages on topics that a client may not publish")

T = TypeVar("T")


@dataclass
class PendingRequest:
    """A request to a service of the client, which waits for its response."""

    topic: str
    type: Any
    response: Any = None
    over: threading.Event = field(default_factory=threading.Event)


class ClientEndpoints:
    """What one client of the bridge subscribes, publishes, calls and serves.

    `send` takes a frame and whether it may be dropped; `say` takes a text for client and log. Subscriptions and
    services are keyed by the name as the client writes it, publishers by the full name.
    `speakers` maps a topic to the client that publishes it; all clients share it. Each operation on it is atomic.
    """

    def __init__(
        self,
        ros: Ros,
        layout: joint_cmd.Layout,
        allowed: Allowed,
        speakers: dict[str, str],
        client: str,
        send: Callable[[bytes, bool], None],
        say: Callable[[str], None],
    ) -> None:
        self._ros, self._layout, self._allowed, self._send, self._say = ros, layout, allowed, send, say
        self._speakers, self._client = speakers, client
        self._published: dict[str, tuple[Any, Any]] = {}  # publisher, type
        self._waiting: dict[str, Registration] = {}  # until another client stops publishing the topic
        self._refused: set[str] = set()
        self._received: dict[str, Hearing] = {}
        self._called: dict[str, Any] = {}  # type
        self._offered: dict[str, tuple[Any, Any]] = {}  # service, type
        self._asked: dict[int, PendingRequest] = {}
        self._numbers = itertools.count(1001)
        self._calls = 0
        self._closed = False
        self._fresh = FreshStart(lambda topic, data: send(encode(topic, data), True), monotonic())
        self._timer = ros.every(FOLLOW_PERIOD, self._follow)

    # registrations

    def publish(self, wanted: Registration) -> None:
        name, kind = full_name(wanted.topic), short_name(wanted.message_name)
        if (why := self._allowed.publishing(name, kind)) is not None:
            self.remove_publisher(name)
            if len(self._refused) < REFUSED:
                self._refused.add(name)
            raise CommandError(why)
        self._refused.discard(name)
        made = interface(wanted.message_name, "msg")
        if self._published.get(name, (None, None))[1] is made:
            return  # the simulator may register twice
        self.remove_publisher(name)
        speaker = self._speakers.setdefault(name, self._client)
        if speaker != self._client:
            self._waiting[name] = wanted
            raise CommandError(f"{name} is published by {speaker}: the messages of a second client are left out")
        try:
            publisher = self._on_ros(lambda: self._ros.publisher(made, name, wanted.queue_size, wanted.latch), wanted)
        except CommandError:
            del self._speakers[name]
            raise
        self._published[name] = publisher, made

    def subscribe(self, wanted: Registration) -> None:
        self._check(self._allowed.hearing, wanted)
        kind = interface(wanted.message_name, "msg")
        self.remove_subscriber(wanted.topic)

        def received(data: bytes) -> None:
            if self._fresh.young():
                return
            try:
                self._send(encode(wanted.topic, self._for_client(kind, bytes(data))), True)
            except joint_cmd.LayoutError as error:
                self._say(f"{wanted.topic}: {error}")

        def stopped(data: bytes) -> None:
            self._fresh.stop(wanted.topic, bytes(data), monotonic())

        name = full_name(wanted.topic)
        if name in self._allowed.stops:
            received = stopped
        self._received[wanted.topic] = self._on_ros(lambda: Hearing(self._ros, kind, name, received), wanted)

    def ros_service(self, wanted: Registration) -> None:
        self._check(self._allowed.calling, wanted)
        kind = interface(wanted.message_name, "srv")
        self._called[wanted.topic] = kind

    def unity_service(self, wanted: Registration) -> None:
        self._check(self._allowed.offering, wanted)
        kind = interface(wanted.message_name, "srv")
        self.remove_unity_service(wanted.topic)

        def answer(request: Any, _response: Any) -> Any:
            return self._ask_client(PendingRequest(wanted.topic, kind), request)

        made = self._on_ros(lambda: self._ros.offer_slow(kind, full_name(wanted.topic), answer), wanted)
        self._offered[wanted.topic] = made, kind

    def remove_publisher(self, topic: str) -> None:
        name = full_name(topic)
        self._waiting.pop(name, None)
        if (gone := self._published.pop(name, None)) is not None:
            self._drop(lambda: self._ros.node.destroy_publisher(gone[0]))
            del self._speakers[name]  # the next client's publisher is made after this one is destroyed

    def remove_subscriber(self, topic: str) -> None:
        if (gone := self._received.pop(topic, None)) is not None:
            self._drop(gone.close)

    def remove_ros_service(self, topic: str) -> None:
        self._called.pop(topic, None)

    def remove_unity_service(self, topic: str) -> None:
        if (gone := self._offered.pop(topic, None)) is not None:
            self._drop(lambda: self._ros.node.destroy_service(gone[0]))

    def close(self) -> None:
        """Remove everything; callers that still wait for the client get no answer."""
        self._closed = True
        self._drop(lambda: self._ros.node.destroy_timer(self._timer))
        for asked in list(self._asked.values()):
            asked.over.set()
        for topics, remove in (
            (self._published, self.remove_publisher), (self._received, self.remove_subscriber),
            (self._offered, self.remove_unity_service),
        ):  # fmt: skip
            for topic in list(topics):
                remove(topic)

    # traffic

    def message(self, topic: str, payload: bytes) -> None:
        """Publish a message of the client byte for byte, after a check that it decodes as its type."""
        name = full_name(topic)
        if name in self._waiting and name not in self._speakers:
            self.publish(self._waiting[name])
            self._say(f"{name}: the other client has left: the messages of this one are taken from now on")
        if name in self._waiting or name in self._refused:
            LEFT_OUT.inc()  # the client got the reason at its registration
            return
        if name not in self._published:
            raise CommandError(f"Not registered to publish topic '{topic}'! Send __publish first")
        publisher, kind = self._published[name]
        read = _read(payload, kind, topic)
        if hasattr(read, "header"):
            self._fresh.told(stamps.seconds(read.header.stamp), monotonic())
        publisher.publish(payload)

    def request(self, topic: str, payload: bytes, number: int) -> None:
        """Call a ROS service for the client; returns at once."""
        if topic not in self._called:
            raise CommandError(f"Not registered to call service '{topic}'! Send __ros_service first")
        if self._calls >= OPEN_CALLS:
            raise CommandError(f"{topic}: {OPEN_CALLS} calls are under way, none more until one is answered")
        kind = self._called[topic]
        wanted = _read(payload, kind.Request, topic)

        async def call() -> None:
            self._calls += 1
            try:
                answer = await self._ros.call_async(kind, full_name(topic), wanted, ANSWER_LIMIT)
            except RosError as error:  # must not end the executor and with it all clients
                self._say(str(error))
                return
            finally:
                self._calls -= 1
            if answer is None:
                self._say(f"service {full_name(topic)} did not answer within {ANSWER_LIMIT:.0f} s: is it there?")
            else:
                self._send(command("__response", srv_id=number) + encode(topic, pack(answer)), False)

        self._ros.start(call)

    def response(self, payload: bytes, number: int) -> None:
        """Take the client's answer to a request."""
        asked = self._asked.get(number)
        if asked is None:
            raise CommandError(f"a response to request {number}, which is not awaited (any more)")
        try:
            asked.response = _read(payload, asked.type.Response, asked.topic)
        finally:
            asked.over.set()

    def topics(self) -> tuple[list[str], list[str]]:
        """All topics of the graph and their types."""
        known = sorted(self._ros.node.get_topic_names_and_types())
        return [name for name, _ in known], [short_name(types[0]) for _, types in known]

    def _ask_client(self, asked: PendingRequest, request: Any) -> Any:
        """Send a request to the client and wait; None when it does not answer. Runs in the thread of this call."""
        if self._closed or len(self._asked) >= OPEN_CALLS:
            return None
        number = next(self._numbers)
        self._asked[number] = asked
        try:
            self._send(command("__request", srv_id=number) + encode(asked.topic, pack(request)), False)
            asked.over.wait(ANSWER_LIMIT)
        finally:
            del self._asked[number]
        if asked.response is None and not self._closed:
            self._say(f"the client did not answer {full_name(asked.topic)} within {ANSWER_LIMIT:.0f} s")
        return asked.response

    def _follow(self) -> None:
        self._fresh.look(monotonic())
        for hearing in list(self._received.values()):
            hearing.follow()

    def _for_client(self, kind: Any, data: bytes) -> bytes:
        return joint_cmd.convert(data, self._layout) if self._foreign(kind) else data

    def _foreign(self, kind: Any) -> bool:
        """Whether the client writes messages of this type in another layout."""
        return self._layout != joint_cmd.OURS and f"{kind.__module__.split('.')[0]}/{kind.__name__}" == joint_cmd.TYPE

    def _check(self, refusal: Callable[[str, str], str | None], wanted: Registration) -> None:
        if (why := refusal(full_name(wanted.topic), short_name(wanted.message_name))) is not None:
            raise CommandError(why)

    def _on_ros(self, step: Callable[[], T], wanted: Registration) -> T:
        try:
            return do(self._ros, step, ROS_LIMIT)
        except (RosError, RuntimeError, ValueError) as error:
            raise CommandError(f"{wanted.topic} ({wanted.message_name}): {error}") from error

    def _drop(self, step: Callable[[], Any]) -> None:
        self._ros.on_executor(step)


def _read(payload: bytes, kind: Any, topic: str) -> Any:
    """Decode a message, so that a damaged one is refused."""
    try:
        return unpack(payload, kind)
    except RuntimeError as error:
        raise CommandError(f"{topic}: what came is no {kind.__name__}, or is damaged") from error
