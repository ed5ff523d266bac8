"""What this system uses of rclpy that is not public, with the rclpy that is installed."""

import threading
import time
from typing import Any

import pytest
from std_msgs.msg import String
from tms_msg_ts.action import LeafNodeBase

from conftest import wait_until
from tms_if.on_executor import do
from tms_reason.reason import Foreign, Reason
from tms_reason.wire import to_line
from tms_ros.client import Call
from tms_ros.goals import Outcome
from tms_ros.node import Ros
from tms_ros.privates import Asleep, take
from tms_ros.quality import topic
from tms_ros.server import AnyGoal

pytestmark = pytest.mark.ros
LIMIT = 20.0  # s


def test_messages_are_taken_with_their_number_and_wake_no_executor(two_nodes: tuple[Ros, Ros]) -> None:
    here, there = two_nodes

    def unreceived(_: String) -> None:
        raise AssertionError("a callback of a group that sleeps")

    subscription = here.node.create_subscription(
        String, "/taken", unreceived, topic(10, False), callback_group=Asleep()
    )
    publisher = there.publisher(String, "/taken")
    wait_until(lambda: publisher.get_subscription_count() == 1, LIMIT, "a reader")
    before = time.monotonic()
    for text in ("one", "two"):
        publisher.publish(String(data=text))
    found: list[tuple[Any, float, int]] = []

    def look() -> bool:
        taken = take(subscription)
        found.extend([] if taken is None else [taken])
        return len(found) == 2

    wait_until(look, LIMIT, "both messages")
    assert [message.data for message, _, _ in found] == ["one", "two"]
    assert [number for _, _, number in found] == [1, 2]
    assert all(before - 0.05 <= received <= time.monotonic() for _, received, _ in found)
    assert take(subscription) is None


def test_the_executor_tells_since_when_it_is_busy(two_nodes: tuple[Ros, Ros]) -> None:
    here, _ = two_nodes
    begun, go_on = threading.Event(), threading.Event()

    def long() -> None:
        begun.set()
        go_on.wait(LIMIT)

    here.on_executor(long)
    assert begun.wait(LIMIT)
    since = here.busy_since()
    go_on.set()
    assert since is not None and since <= time.monotonic()
    wait_until(lambda: here.busy_since() is None, LIMIT, "it waits")


def test_ids_that_arrive_and_feedback_that_comes_before_its_result(
    two_nodes: tuple[Ros, Ros],
) -> None:
    here, there = two_nodes

    def run(goal: AnyGoal) -> tuple[Outcome, LeafNodeBase.Result]:
        for number in range(8):
            goal.publish(LeafNodeBase.Feedback(status=str(number)))
        return Outcome.SUCCEEDED, LeafNodeBase.Result(result=True)

    def accept(_: LeafNodeBase.Goal) -> Reason | None:
        return Foreign("not today") if refuses.is_set() else None

    refuses = threading.Event()
    there.serve(LeafNodeBase, "/privates/leaf", run, accept)
    peer = here.peer(LeafNodeBase, "/privates/leaf")
    peer.wait_ready(LIMIT)
    assert here.node.count_publishers("/privates/leaf/_action/feedback") == 1  # which also says why a goal is refused
    said: list[str] = []
    call: Call[Any, Any] = peer.send(
        LeafNodeBase.Goal(), goal_id=b"0123456789abcdef", on_feedback=lambda f: said.append(f.status)
    )
    assert call.wait_for(lambda: call.outcome is not None, LIMIT)
    assert (call.outcome, said) == (Outcome.SUCCEEDED, [str(number) for number in range(8)])
    refuses.set()
    refused = peer.send(LeafNodeBase.Goal())
    assert refused.wait_for(lambda: refused.outcome is not None and refused.feedback is not None, LIMIT)
    assert refused.feedback.status == to_line(Foreign("not today"))  # said under the id that was arriving
    client = peer._client
    assert refused.id in client._feedback_callbacks  # rclpy keeps those of goals that had no result
    do(here, lambda: client.forget(refused.id), LIMIT)
    assert refused.id not in client._feedback_callbacks
    assert bytes(client.handle_of(call.id).goal_id.uuid) == call.id
