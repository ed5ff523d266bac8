"""A process's part of the ROS graph: how many endpoints it is connected to, and which it cannot connect to.

Each question goes through the whole graph of the site: all of a scheduler take 110 ms at thirty machines. So they are
asked one by one and only after a change, in a thread of their own: on the executor, a press of the stop would wait.
"""

from contextlib import suppress
from itertools import product
from typing import Any

from tms_config.clock import monotonic, sleep
from tms_ros.loop import InvalidHandle
from tms_ros.node import Ros
from tms_ros.quality import misfit
from tms_runtime import metrics
from tms_runtime.log import Logger
from tms_runtime.reasons import NotConnected

LOOK_PERIOD, CHECK_PERIOD = 5.0, 60.0  # s between looks for other nodes, and at most until the next check
UNKNOWN = "_NODE_NAME_UNKNOWN_"  # of an endpoint that was discovered a moment before its node
RCLPYS_OWN = "/parameter_events"
PAUSE = 0.04  # s between two topics: ten gateways that start together must not fill the PC


class Graph:
    """Checks the graph periodically; logs an endpoint that does not fit when it is first seen."""

    def __init__(self, ros: Ros, log: Logger) -> None:
        self._ros, self._log = ros, log
        self._counts: dict[str, tuple[int, int]] = {}  # see `counts_of`, of each topic that was checked
        self._reported: dict[str, set[NotConnected]] = {}  # by topic
        ros.begin(self._run, "graph")

    def _run(self) -> None:
        known, checked = list[str](), monotonic()
        while not self._ros.closing:
            sleep(LOOK_PERIOD)  # first: a process that has just started is not connected to all others yet
            with suppress(InvalidHandle):  # of what was destroyed meanwhile: the next look sees what is there
                names = sorted(self._ros.node.get_node_names())
                metrics.NODES.set(len(names))
                if names != known or monotonic() - checked > CHECK_PERIOD:
                    self.check()
                    known, checked = names, monotonic()

    def check(self) -> None:
        """Check every topic of this process once; from one thread only."""
        node, unknown = self._ros.node, (0, 0)
        topics = {end.topic_name for end in [*node.publishers, *node.subscriptions]} - {RCLPYS_OWN}
        for topic in sorted(topics):
            self._check(topic)
            sleep(PAUSE)
        readers = sum(end.get_subscription_count() for end in list(node.publishers))
        writers = sum(self._counts.get(end.topic_name, unknown)[0] for end in list(node.subscriptions))
        metrics.ENDPOINTS.labels("readers").set(readers)
        metrics.ENDPOINTS.labels("writers").set(writers)

    def _check(self, topic: str) -> None:
        counts = counts_of(self._ros, topic)
        if counts == self._counts.get(topic) or (found := mismatches(self._ros, topic)) is None:
            return  # nothing new, or a name that is not known yet: the next check looks again
        for reason in sorted(found - self._reported.get(topic, set()), key=repr):
            self._log.warning("not_connected", reason=reason)
        self._counts[topic], self._reported[topic] = counts, found


def counts_of(ros: Ros, topic: str) -> tuple[int, int]:
    """How many publishers and subscriptions a topic has in the whole graph."""
    return ros.node.count_publishers(topic), ros.node.count_subscribers(topic)


def mismatches(ros: Ros, topic: str) -> set[NotConnected] | None:
    """Others' endpoints on a topic of ours without a connection to us, and why; None while a name is unknown."""
    writers = ros.node.get_publishers_info_by_topic(topic)
    readers = ros.node.get_subscriptions_info_by_topic(topic)
    if any(end.node_name == UNKNOWN for end in [*writers, *readers]):
        return None
    own, found = ros.node.get_fully_qualified_name(), set[NotConnected]()
    for writer, reader in product(writers, readers):
        sender, receiver = node_of(writer), node_of(reader)
        if own in (sender, receiver) and sender != receiver and (reason := _mismatch(writer, reader)):
            found.add(NotConnected(topic, receiver, sender, reason))
    return found


def _mismatch(writer: Any, reader: Any) -> str:
    """Why DDS does not connect two endpoints of a topic; empty when it does."""
    if writer.topic_type != reader.topic_type:
        return f"{writer.topic_type} is not {reader.topic_type}"
    return misfit(writer.qos_profile, reader.qos_profile)


def node_of(endpoint: Any) -> str:
    """Full name of the node that an endpoint of rclpy's graph belongs to."""
    return f"{endpoint.node_namespace.rstrip('/')}/{endpoint.node_name}"
