"""What a process tells of ends that DDS does not connect."""

import logging

import pytest
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import Bool, String

from conftest import wait_until
from tms_core import graph
from tms_core.ros import Ros

pytestmark = pytest.mark.ros
LIMIT = 20.0  # s for whatever must happen at all
ACTED = "/emergency_signal"


def told(caplog: pytest.LogCaptureFixture, text: str) -> int:
    return sum(text in record.getMessage() for record in caplog.records)


def test_a_publisher_that_nobody_can_hear_is_told_once(
    two_nodes: tuple[Ros, Ros], caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(graph, "PERIOD", 0.05)
    here, foreign = two_nodes
    here.subscribe(Bool, ACTED, lambda _: None)
    foreign.node.create_publisher(Bool, ACTED, QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
    with caplog.at_level(logging.WARNING):
        graph.Graph(here, logging.getLogger("test"))
        text = f"{ACTED}: /server does not hear /client: Best effort publisher and reliable subscription"
        wait_until(lambda: told(caplog, text) > 0, LIMIT, "told")
        heard: list[Bool] = []
        here.subscribe(Bool, "/other", heard.append)  # something changes, so that it looks again
        other = foreign.publisher(Bool, "/other", latched=True)
        wait_until(lambda: other.get_subscription_count() > 0, LIMIT, "connected")
        wait_until(lambda: here.ends()[1] == 2, LIMIT, "seen")
        here.do(lambda: None, LIMIT)
    assert told(caplog, "does not hear") == 1


def test_another_type_on_our_topic_is_told(two_nodes: tuple[Ros, Ros]) -> None:
    here, foreign = two_nodes
    here.publisher(Bool, ACTED)
    foreign.subscribe(String, ACTED, lambda _: None)
    expected = {f"{ACTED}: /client does not hear /server: std_msgs/msg/Bool is not std_msgs/msg/String"}
    wait_until(lambda: here.mismatches(ACTED) == expected, LIMIT, "told")


def test_ends_that_fit_are_not_told(two_nodes: tuple[Ros, Ros]) -> None:
    here, foreign = two_nodes
    heard: list[Bool] = []
    foreign.subscribe(Bool, ACTED, heard.append, best_effort=True)
    publisher = here.publisher(Bool, ACTED, latched=True)

    def arrives() -> bool:
        publisher.publish(Bool(data=True))
        return bool(heard)

    wait_until(arrives, LIMIT, "heard")
    assert here.mismatches(ACTED) == set()
