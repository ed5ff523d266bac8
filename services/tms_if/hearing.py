"""A topic as a client hears it: with the quality of service of those who publish it at the moment."""

from collections.abc import Callable
from typing import Any

from tms_interfaces.generated import Message
from tms_ros.node import Ros
from tms_ros.quality import topic


class Hearing:
    """A subscription that is made anew when its publishers offer something else; on the executor thread only.

    A client may subscribe before its publisher is there or is discovered. Without `follow` it would then never get
    what a latched publisher has said before, such as the stop of a machine.
    """

    def __init__(self, ros: Ros, kind: type[Message], topic: str, on_message: Callable[[bytes], None]) -> None:
        self._ros, self._kind, self._topic, self._on_message = ros, kind, topic, on_message
        self._quality = self._wanted()
        self._subscription = self._subscribed()

    def follow(self) -> None:
        """Subscribe anew where the present publishers need another quality of service."""
        if (wanted := self._wanted()) == self._quality:
            return
        self.close()
        self._quality = wanted
        self._subscription = self._subscribed()

    def close(self) -> None:
        """End the subscription."""
        self._ros.node.destroy_subscription(self._subscription)

    def _wanted(self) -> Any:  # a quality of service of rclpy
        """A reliable reader would not receive from a best-effort writer, and a volatile reader no earlier messages."""
        offered = [info.qos_profile for info in self._ros.node.get_publishers_info_by_topic(self._topic)]
        latched = bool(offered) and all(one.durability.name == "TRANSIENT_LOCAL" for one in offered)
        return topic(10, latched, any(one.reliability.name == "BEST_EFFORT" for one in offered))

    def _subscribed(self) -> Any:
        return self._ros.subscribe_raw(self._kind, self._topic, self._on_message, self._quality)
