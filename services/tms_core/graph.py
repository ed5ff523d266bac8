"""What a process sees of the ROS graph: how many ends it is connected to, and which ones it cannot be connected to."""

import logging

from tms_core import metrics
from tms_core.ros import Ros

PERIOD = 5.0  # s between looks
TOPICS = 20  # a look: each takes some 0.2 ms of the executor


class Graph:
    """Looks from time to time; an end that does not fit is told in the log when it is seen first."""

    def __init__(self, ros: Ros, log: logging.Logger) -> None:
        self._ros, self._log = ros, log
        self._ends: tuple[int, ...] = ()
        self._unseen: list[str] = []  # topics to look at since something has changed
        self._told: dict[str, set[str]] = {}  # by topic
        ros.every(PERIOD, self._look)

    def _look(self) -> None:
        ends = self._ros.ends()
        if ends != self._ends:
            self._ends, self._unseen = ends, sorted(self._ros.topics())
            readers, writers, nodes = ends
            metrics.ENDPOINTS.labels("readers").set(readers)
            metrics.ENDPOINTS.labels("writers").set(writers)
            metrics.NODES.set(nodes)
        now, self._unseen = self._unseen[:TOPICS], self._unseen[TOPICS:]
        for topic in now:
            found = self._ros.mismatches(topic)
            for text in sorted(found - self._told.get(topic, set())):
                self._log.warning("event=not_connected reason=%r", text)
            self._told[topic] = found
