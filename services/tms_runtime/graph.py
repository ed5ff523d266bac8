"""A process's part of the ROS graph: how many endpoints it is connected to, and which it cannot connect to."""

from itertools import product
from typing import Any

from tms_ros.node import Ros
from tms_ros.quality import misfit
from tms_runtime import metrics
from tms_runtime.log import Logger
from tms_runtime.reasons import NotConnected

GRAPH_CHECK_PERIOD = 5.0  # s between checks
UNKNOWN = "_NODE_NAME_UNKNOWN_"  # of an endpoint that was discovered a moment before its node
RCLPYS_OWN = "/parameter_events"
TOPICS = 20  # topics per check: each takes some 0.3 ms of the executor


class Graph:
    """Checks the graph periodically; logs an endpoint that does not fit when it is first seen."""

    def __init__(self, ros: Ros, log: Logger) -> None:
        self._ros, self._log = ros, log
        self._peers: dict[str, tuple[int, int]] = {}
        self._changed: list[str] = []  # topics that are still to be checked
        self._reported: dict[str, set[NotConnected]] = {}  # by topic
        ros.every(GRAPH_CHECK_PERIOD, self.check)

    def check(self) -> None:
        """Check the graph; on the executor thread, where it is also called periodically."""
        readers, writers, nodes = endpoint_counts(self._ros)
        metrics.ENDPOINTS.labels("readers").set(readers)
        metrics.ENDPOINTS.labels("writers").set(writers)
        metrics.NODES.set(nodes)
        counts = peer_counts(self._ros)
        changed = [topic for topic in sorted(counts) if counts[topic] != self._peers.get(topic)]
        self._changed += [topic for topic in changed if topic not in self._changed]
        self._peers = counts
        now, self._changed = self._changed[:TOPICS], self._changed[TOPICS:]
        for topic in now:
            self._publish(topic)

    def _publish(self, topic: str) -> None:
        found = mismatches(self._ros, topic)
        if found is None:
            self._changed.append(topic)
            return
        for reason in sorted(found - self._reported.get(topic, set()), key=repr):
            self._log.warning("not_connected", reason=reason)
        self._reported[topic] = found


def endpoint_counts(ros: Ros) -> tuple[int, int, int]:
    """Remote readers of our publishers, remote writers of our subscriptions, nodes; on the executor thread."""
    node = ros.node
    readers = sum(end.get_subscription_count() for end in list(node.publishers))
    writers = sum(node.count_publishers(end.topic_name) for end in list(node.subscriptions))
    return readers, writers, len(node.get_node_names())


def peer_counts(ros: Ros) -> dict[str, tuple[int, int]]:
    """How many publishers and subscriptions each topic of ours has in the whole graph."""
    node = ros.node
    topics = {end.topic_name for end in [*node.publishers, *node.subscriptions]} - {RCLPYS_OWN}
    return {topic: (node.count_publishers(topic), node.count_subscribers(topic)) for topic in topics}


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
