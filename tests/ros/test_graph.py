"""What a process tells of ends that DDS does not connect."""

import logging
from contextlib import closing
from uuid import uuid4

import pytest
import structlog
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import Bool, String
from std_srvs.srv import Trigger

from conftest import wait_until
from tms_ros.node import Ros
from tms_runtime.graph import Graph, counts_of, mismatches

pytestmark = pytest.mark.ros
LIMIT = 20.0  # s for whatever must happen at all
ACTED = "/emergency_signal"


class Watched:
    """The looks of one process at the graph, and what it told."""

    def __init__(self, ros: Ros, caplog: pytest.LogCaptureFixture) -> None:
        self._caplog = caplog
        caplog.set_level(logging.WARNING)
        self._graph = Graph(ros, structlog.stdlib.get_logger("test"))

    def reported(self) -> list[str]:
        self._graph.check()
        return [record.getMessage() for record in self._caplog.records if record.name == "test"]


@pytest.fixture
def watched(two_nodes: tuple[Ros, Ros], caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch) -> Watched:
    monkeypatch.setattr(two_nodes[0], "begin", lambda *_: None)  # it looks when it is told to
    return Watched(two_nodes[0], caplog)


def test_a_process_offers_no_service_that_nobody_uses(own_domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each one is discovered by every other process: with fifty of them, that is most of what a start costs."""
    monkeypatch.setenv("ROS_DOMAIN_ID", str(own_domain))
    name = f"offers_{uuid4().hex}"  # the graph may still know a node of an earlier test
    with closing(Ros(name)) as here, closing(Ros("asks")) as other:
        here.offer(Trigger, f"/{name}", lambda _, response: response)

        def services() -> list[str]:
            there = (name, "/") in other.node.get_node_names_and_namespaces()
            return [found for found, _ in other.node.get_service_names_and_types_by_node(name, "/")] if there else []

        wait_until(lambda: f"/{name}" in services(), LIMIT, "seen")
        assert services() == [f"/{name}"]


def test_a_publisher_that_nobody_can_hear_is_told_once(two_nodes: tuple[Ros, Ros], watched: Watched) -> None:
    here, foreign = two_nodes
    here.subscribe(Bool, ACTED, lambda _: None)
    foreign.node.create_publisher(Bool, ACTED, QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
    text = f"topic='{ACTED}', reader='/server', writer='/client', problem='Best effort publisher and reliable"
    wait_until(lambda: any(text in line for line in watched.reported()), LIMIT, "told")
    foreign.publisher(Bool, ACTED)  # one that fits: the topic is looked at again
    wait_until(lambda: counts_of(here, ACTED) == (2, 1), LIMIT, "seen")
    wait_until(lambda: mismatches(here, ACTED) is not None, LIMIT, "known by name")
    assert len(watched.reported()) == 1


def test_a_subscription_of_another_type_that_comes_later_is_told(two_nodes: tuple[Ros, Ros], watched: Watched) -> None:
    here, foreign = two_nodes
    here.publisher(Bool, ACTED)
    assert watched.reported() == []
    foreign.subscribe(String, ACTED, lambda _: None)
    text = f"topic='{ACTED}', reader='/client', writer='/server', problem='std_msgs/msg/Bool is not std_msgs/msg/String"
    wait_until(lambda: any(text in line for line in watched.reported()), LIMIT, "told")


def test_ends_that_fit_are_not_told(two_nodes: tuple[Ros, Ros], watched: Watched) -> None:
    here, foreign = two_nodes
    received: list[Bool] = []
    foreign.subscribe(Bool, ACTED, received.append, best_effort=True)
    publisher = here.publisher(Bool, ACTED, latched=True)

    def arrives() -> bool:
        publisher.publish(Bool(data=True))
        return bool(received)

    wait_until(arrives, LIMIT, "heard")
    wait_until(lambda: mismatches(here, ACTED) is not None, LIMIT, "known by name")
    assert watched.reported() == []
