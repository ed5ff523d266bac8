"""Topics: published, subscribed, sampled, and leased.

rclpy's own warnings of endpoints that do not fit are switched off: they are events that the executor waits for, and
those of each topic cost every wake-up 10 us, three quarters of its time. `tms_runtime.graph` reports the same.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import islice
from typing import Any, Generic

from rclpy.callback_groups import CallbackGroup
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.exceptions import InvalidHandle
from rclpy.qos import QoSProfile

from tms_interfaces.generated import M, Message, Publisher
from tms_ros import quality
from tms_ros.loop import EventLoop
from tms_ros.privates import Asleep, take


@dataclass(frozen=True)
class Arrival(Generic[M]):
    """A message, with its reception time and number."""

    message: M
    received: float  # s, monotonic
    number: int  # counted by the publisher


class Topics:
    """The topics of a node."""

    def __init__(self, loop: EventLoop) -> None:
        self._loop = loop

    def publisher(
        self, message_type: type[M], topic: str, depth: int = 10, latched: bool = False, lives: float = 0.0
    ) -> Publisher[M]:
        """A reliable publisher; `latched`: later subscribers get the last message, if not older than `lives` [s]."""
        return self._published(message_type, topic, quality.topic(depth, latched, lives=lives))

    def _published(self, message_type: type[M], topic: str, qos: QoSProfile) -> Publisher[M]:
        quiet = PublisherEventCallbacks(use_default_callbacks=False)
        made: Publisher[M] = self._loop.node.create_publisher(message_type, topic, qos, event_callbacks=quiet)
        return made

    def _subscribed(
        self,
        message_type: type[Message],
        topic: str,
        on_message: Callable[[Any], None],
        qos: QoSProfile,
        group: CallbackGroup | None = None,
        liveliness: Callable[[Any], None] | None = None,
        raw: bool = False,
    ) -> Any:
        events = SubscriptionEventCallbacks(liveliness=liveliness, use_default_callbacks=False)
        return self._loop.node.create_subscription(
            message_type, topic, on_message, qos, callback_group=group or self._loop.group,
            event_callbacks=events, raw=raw,
        )  # fmt: skip

    def delivered(self, publisher: Publisher[M], seconds: float) -> bool:
        """Wait until all readers have the published messages; False if they do not within `seconds`."""
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
        """Call `on_message` on the executor thread; depth 1 means that only the latest message counts.

        A best-effort subscription also receives from reliable publishers, a reliable one not from best-effort ones.
        Waiting messages are handled in one go: a turn of the executor for each costs four times a callback's work.
        """
        subscription: Any = None

        def all_that_wait(message: M) -> None:
            on_message(message)
            for _ in range(depth - 1 if subscription else 0):  # a message may come before the assignment below
                try:
                    waiting = take(subscription)
                except InvalidHandle:  # `on_message` has ended the subscription
                    return
                if waiting is None:
                    return
                on_message(waiting[0])

        subscription = self._subscribed(message_type, topic, all_that_wait, quality.topic(depth, latched, best_effort))
        return subscription

    def sample(self, message_type: type[M], topic: str, depth: int = 1) -> Callable[[], list[M]]:
        """A function that returns the last `depth` messages since its last call, oldest first; from any thread.

        Messages do not wake the executor, which costs more than to take them.
        """
        arrivals = self.sample_arrivals(message_type, topic, depth)
        return lambda: [arrival.message for arrival in arrivals()]

    def sample_arrivals(
        self, message_type: type[M], topic: str, depth: int = 1, best_effort: bool = True
    ) -> Callable[[], list[Arrival[M]]]:
        """As `sample`, with each message's reception time and number; `best_effort`: lost ones are not sent again."""
        qos = quality.topic(depth, False, best_effort)
        reader = self._subscribed(message_type, topic, lambda _: None, qos, Asleep())
        return lambda: [Arrival(*taken) for taken in islice(iter(lambda: take(reader), None), depth)]

    def subscribe_raw(
        self, message_type: type[Message], topic: str, on_message: Callable[[bytes], None], qos: QoSProfile
    ) -> Any:
        """Call `on_message` with each serialised message."""
        return self._subscribed(message_type, topic, on_message, qos, raw=True)

    def lease_publisher(self, message_type: type[M], topic: str, seconds: float) -> Publisher[M]:
        """A latched publisher; DDS notifies its readers when it was not asserted for `seconds`."""
        return self._published(message_type, topic, quality.lease(seconds))

    def lease_subscribe(
        self,
        message_type: type[M],
        topic: str,
        seconds: float,
        on_message: Callable[[M], None],
        on_liveliness: Callable[[Any], None],
    ) -> Any:
        """Call `on_message` with messages and `on_liveliness` with DDS's reports on the assertions of publishers."""
        return self._subscribed(message_type, topic, on_message, quality.lease(seconds), liveliness=on_liveliness)
