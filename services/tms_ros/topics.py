"""Topics: what is published, heard, sampled, and leased.

rclpy's own warnings of ends that do not fit are switched off: they are events that the executor waits for, and each
topic's cost every wake-up 10 us, three quarters of it all. `mismatches` tells the same when it is asked.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import Any, Generic

from rclpy.callback_groups import CallbackGroup
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.exceptions import InvalidHandle
from rclpy.qos import QoSCompatibility, QoSProfile, qos_check_compatible

from tms_ros import quality
from tms_ros.interface_types import M, Message, Publisher
from tms_ros.loop import Loop
from tms_ros.privates import Asleep, take
from tms_ros.reasons import NotConnected

ASSERTED = 0.1  # s in which the news that a publisher is asserted follows its message, twice
UNKNOWN = "_NODE_NAME_UNKNOWN_"  # of an end that discovery has found a moment before its node


@dataclass(frozen=True)
class Arrival(Generic[M]):
    """A message with what the middleware knows of its way."""

    message: M
    received: float  # s, monotonic
    number: int  # of the publisher's messages


class Topics:
    """The topics of a node."""

    def __init__(self, loop: Loop) -> None:
        self._loop = loop

    def publisher(self, message_type: type[M], topic: str, depth: int = 10, latched: bool = False) -> Publisher[M]:
        """A reliable publisher; `latched` gives the last message to whoever comes later."""
        return self._published(message_type, topic, quality.topic(depth, latched))

    def _published(self, message_type: type[M], topic: str, quality_of_service: QoSProfile) -> Publisher[M]:
        quiet = PublisherEventCallbacks(use_default_callbacks=False)
        made: Publisher[M] = self._loop.node.create_publisher(
            message_type, topic, quality_of_service, event_callbacks=quiet
        )
        return made

    def _subscribed(
        self,
        message_type: type[Message],
        topic: str,
        on_message: Callable[[Any], None],
        quality_of_service: QoSProfile,
        group: CallbackGroup | None = None,
        liveliness: Callable[[Any], None] | None = None,
        raw: bool = False,
    ) -> Any:
        events = SubscriptionEventCallbacks(liveliness=liveliness, use_default_callbacks=False)
        return self._loop.node.create_subscription(
            message_type, topic, on_message, quality_of_service, callback_group=group or self._loop.group,
            event_callbacks=events, raw=raw,
        )  # fmt: skip

    def delivered(self, publisher: Publisher[M], seconds: float) -> bool:
        """Wait until all readers have what was published; False: not within `seconds`."""
        return bool(publisher.wait_for_all_acked(Duration(seconds=seconds)))

    def subscribe(
        self,
        message_type: type[M],
        topic: str,
        on_message: Callable[[M], None],
        depth: int = 1,
        latched: bool = False,
        best_effort: bool = False,
    ) -> Any:
        """Call `heard` on the executor thread; depth 1 means that only the latest counts.

        A best-effort subscription also hears reliable publishers, a reliable one hears no best-effort publisher.
        What waits is handled in one go: a turn of the executor for each message costs four times a callback's work.
        """
        subscription: Any = None

        def all_that_wait(message: M) -> None:
            on_message(message)
            if subscription is None:  # this one came before the assignment below
                return
            for _ in range(depth - 1):
                try:
                    waiting = take(subscription)
                except InvalidHandle:  # `heard` has ended the subscription
                    return
                if waiting is None:
                    return
                on_message(waiting[0])

        subscription = self._subscribed(message_type, topic, all_that_wait, quality.topic(depth, latched, best_effort))
        return subscription

    def sample(self, message_type: type[M], topic: str, depth: int = 1) -> Callable[[], list[M]]:
        """What asks for the last `depth` messages that came since it was asked last, oldest first; from any thread.

        Messages do not wake the executor, which costs more than to take them.
        """
        arrivals = self.sample_arrivals(message_type, topic, depth)
        return lambda: [arrival.message for arrival in arrivals()]

    def sample_arrivals(
        self, message_type: type[M], topic: str, depth: int = 1, best_effort: bool = True
    ) -> Callable[[], list[Arrival[M]]]:
        """As `sample`, with when each message came and its number; `best_effort`: lost ones are not asked for again."""
        subscription = self._subscribed(
            message_type, topic, _unheard, quality.topic(depth, False, best_effort=best_effort), Asleep()
        )

        def take_new() -> list[Arrival[M]]:
            found: list[Arrival[M]] = []
            while len(found) < depth and (arrival := _arrival(subscription)) is not None:
                found.append(arrival)
            return found

        return take_new

    def publishers(self, topic: str) -> list[tuple[str, str]]:
        """Node and type of each publisher of a topic in the whole graph."""
        found = self._loop.node.get_publishers_info_by_topic(topic)
        return [(f"{end.node_namespace.rstrip('/')}/{end.node_name}", end.topic_type) for end in found]

    def publisher_count(self, topic: str) -> int:
        """How many publishers a topic has in the whole graph."""
        return int(self._loop.node.count_publishers(topic))

    def subscribe_raw(self, message_type: type[Message], topic: str, on_message: Callable[[bytes], None]) -> Any:
        """Call `heard` with each message as it is on the wire, with the QoS of those who publish now."""
        offered = [info.qos_profile for info in self._loop.node.get_publishers_info_by_topic(topic)]
        return self._subscribed(message_type, topic, on_message, quality.as_offered(offered), raw=True)

    def lease_publisher(self, message_type: type[M], topic: str, seconds: float) -> Publisher[M]:
        """A latched publisher whose readers are told when it was not asserted for `seconds`."""
        return self._published(message_type, topic, quality.lease(seconds))

    def lease_subscribe(
        self,
        message_type: type[M],
        topic: str,
        seconds: float,
        on_message: Callable[[M], None],
        alive: Callable[[int, int], None],
    ) -> Any:
        """Call `heard` with messages and `alive` with the numbers of publishers that are, and are not, asserted.

        A publisher that was killed counts as not asserted until discovery has dropped it.
        """

        count = _Count(alive)

        def received_first(message: M) -> None:
            if not count.known:
                # In two steps: what was reported meanwhile is handled before the second one.
                self._loop.after(ASSERTED, lambda: self._loop.after(ASSERTED, count.made_up))
            on_message(message)

        return self._subscribed(message_type, topic, received_first, quality.lease(seconds), liveliness=count.reported)

    def mismatches(self, topic: str) -> set[NotConnected] | None:
        """What of others is on a topic of ours but not connected to us, and why; None while one's name is not known."""
        writers = self._loop.node.get_publishers_info_by_topic(topic)
        readers = self._loop.node.get_subscriptions_info_by_topic(topic)
        if any(end.node_name == UNKNOWN for end in [*writers, *readers]):
            return None
        own, found = self._loop.node.get_fully_qualified_name(), set[NotConnected]()
        for writer, reader in product(writers, readers):
            names = [f"{end.node_namespace.rstrip('/')}/{end.node_name}" for end in (writer, reader)]
            if own in names and names[0] != names[1] and (reason := _mismatch(writer, reader)):
                found.add(NotConnected(topic, names[1], names[0], reason))
        return found


def _mismatch(writer: Any, reader: Any) -> str:
    """Why DDS does not connect two ends of a topic; empty when it does."""
    if writer.topic_type != reader.topic_type:
        return f"{writer.topic_type} is not {reader.topic_type}"
    found, reason = qos_check_compatible(writer.qos_profile, reader.qos_profile)
    return str(reason).removeprefix("ERROR: ").rstrip("; ") if found == QoSCompatibility.ERROR else ""


class _Count:
    """Publishers that are, and are not, asserted, as one subscription knows them.

    Fast DDS tells a reader of changes only, and not of those from before it is registered: of a publisher that was
    asserted a moment too early, or that another reader of this process knows already, it counts from 0 down to -1.
    Such a one has sent its message all the same, and that counts as an assertion.
    """

    def __init__(self, alive: Callable[[int, int], None]) -> None:
        self._alive, self._missed = alive, 0
        self.known = False  # whether anything was reported

    def reported(self, event: Any) -> None:
        """By DDS."""
        self.known = True
        self._missed = max(self._missed, -event.alive_count)
        if event.not_alive_count < 0:  # the one that was missed has ended since, and that was missed, too
            self._missed = 0
        self._alive(max(0, event.alive_count + self._missed), max(0, event.not_alive_count))

    def made_up(self) -> None:
        """A message came, and nothing was reported."""
        if not self.known:
            self.known, self._missed = True, 1
            self._alive(1, 0)


def _arrival(subscription: Any) -> Arrival[Any] | None:
    """The oldest message that waits, and how it came."""
    taken = take(subscription)
    return None if taken is None else Arrival(*taken)


def _unheard(message: Message) -> None:
    raise AssertionError("messages of a sampled topic are taken, not heard")
