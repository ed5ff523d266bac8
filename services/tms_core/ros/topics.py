"""Topics: what is published, heard, sampled, and leased."""

from collections.abc import Callable
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.duration import Duration
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.exceptions import InvalidHandle

from tms_core.ros import quality
from tms_core.ros.goals import InterfaceType, Message
from tms_core.ros.loop import Loop


class Topics(Loop):
    """The topics of a node."""

    def publisher(self, message_type: InterfaceType, topic: str, depth: int = 10, latched: bool = False) -> Any:
        """A reliable publisher; `latched` gives the last message to whoever comes later."""
        return self.node.create_publisher(message_type, topic, quality.topic(depth, latched))

    def delivered(self, publisher: Any, seconds: float) -> bool:
        """Wait until all readers have what was published; False: not within `seconds`."""
        return bool(publisher.wait_for_all_acked(Duration(seconds=seconds)))

    def subscribe(
        self,
        message_type: InterfaceType,
        topic: str,
        heard: Callable[[Message], None],
        depth: int = 1,
        latched: bool = False,
        best_effort: bool = False,
    ) -> Any:
        """Call `heard` on the executor thread; depth 1 means that only the latest counts.

        A best-effort subscription also hears reliable publishers, a reliable one hears no best-effort publisher.
        What waits is heard in one go: for each message of its own, the executor does four times the work of a callback.
        """
        subscription: Any = None

        def all_that_wait(message: Message) -> None:
            heard(message)
            if subscription is None:  # this one came before the assignment below
                return
            for _ in range(depth - 1):
                try:
                    waiting = _take(subscription)
                except InvalidHandle:  # `heard` has ended the subscription
                    return
                if waiting is None:
                    return
                heard(waiting)

        subscription = self.node.create_subscription(
            message_type, topic, all_that_wait, quality.topic(depth, latched, best_effort), callback_group=self.group
        )
        return subscription

    def sample(self, message_type: InterfaceType, topic: str, depth: int = 1) -> Callable[[], list[Message]]:
        """What asks for the last `depth` messages that came since it was asked last, oldest first; from any thread.

        Messages do not wake the executor, which costs more than to take them.
        """
        subscription = self.node.create_subscription(
            message_type, topic, _unheard, quality.topic(depth, False, best_effort=True), callback_group=_Asleep()
        )

        def news() -> list[Message]:
            found: list[Message] = []
            while len(found) < depth and (message := _take(subscription)) is not None:
                found.append(message)
            return found

        return news

    def subscribe_raw(self, message_type: InterfaceType, topic: str, heard: Callable[[bytes], None]) -> Any:
        """Call `heard` with each message as it is on the wire, with the QoS of those who publish now."""
        offered = [info.qos_profile for info in self.node.get_publishers_info_by_topic(topic)]
        return self.node.create_subscription(
            message_type, topic, heard, quality.as_offered(offered), callback_group=self.group, raw=True
        )

    def lease_publisher(self, message_type: InterfaceType, topic: str, seconds: float) -> Any:
        """A latched publisher whose readers are told when it was not asserted for `seconds`."""
        return self.node.create_publisher(message_type, topic, quality.lease(seconds))

    def lease_subscribe(
        self,
        message_type: InterfaceType,
        topic: str,
        seconds: float,
        heard: Callable[[Message], None],
        alive: Callable[[int, int], None],
    ) -> Any:
        """Call `heard` with messages and `alive` with the numbers of publishers that are, and are not, asserted.

        A publisher that was killed counts as not asserted until discovery has dropped it.
        """
        events = SubscriptionEventCallbacks(liveliness=lambda event: alive(event.alive_count, event.not_alive_count))
        return self.node.create_subscription(
            message_type, topic, heard, quality.lease(seconds), callback_group=self.group, event_callbacks=events
        )


class _Asleep(CallbackGroup):  # type: ignore[misc]
    """Of subscriptions that the executor must not wait for."""

    def can_execute(self, entity: Any) -> bool:
        return False

    def beginning_execution(self, entity: Any) -> bool:
        return False

    def ending_execution(self, entity: Any) -> None:
        raise AssertionError("nothing of this group is executed")


def _take(subscription: Any) -> Message | None:
    """The oldest message that waits."""
    with subscription.handle:
        taken = subscription.handle.take_message(subscription.msg_type, False)
    return None if taken is None else taken[0]


def _unheard(message: Message) -> None:
    raise AssertionError("messages of a sampled topic are taken, not heard")
