"""The fault `second_publisher`: another publisher reports that the machine stands where the fault began."""

from collections.abc import Callable
from typing import Any

from tms_config.clock import unix_ns
from tms_ros.node import Ros
from tms_sim.sensor_model import Reading
from tms_sim.sources import Topic

PUBLISH_PERIOD = 1 / 60  # s


class Impostor:
    """Has publishers of its own on the machine's topics while the fault is on."""

    def __init__(self, ros: Ros, made: Callable[[], list[Topic]]) -> None:
        self._ros, self._made = ros, made
        self._topics: list[Topic] = []
        self._timer: Any = None
        self._reading: Reading | None = None

    def switch(self, reported: Reading, on: bool) -> None:
        """Begin or end, on the executor thread."""
        if on and self._timer is None:
            self._reading, self._topics = reported.standing(), self._made()
            self._timer = self._ros.every(PUBLISH_PERIOD, self._publish)
        elif not on and self._timer is not None:
            self._ros.node.destroy_timer(self._timer)
            for topic in self._topics:
                self._ros.node.destroy_publisher(topic.publisher)
            self._timer, self._topics = None, []

    def _publish(self) -> None:
        assert self._reading is not None
        for topic in self._topics:
            topic.publish(self._reading._replace(stamp=unix_ns()))
