"""The border's relay between real action servers: results, feedback, cancels and losses reach the other side."""

import threading
from collections.abc import Callable
from typing import Any
from uuid import uuid4

import pytest
from com3_msgs.action import SetSwingAngle

from conftest import wait_until
from tms_if.relay import Relay
from tms_machine.reasons import Busy
from tms_reason.reason import Reason
from tms_ros.client import Call
from tms_ros.goals import Ended, Outcome
from tms_ros.node import Ros
from tms_ros.server import Goal

pytestmark = pytest.mark.ros
LIMIT = 20.0  # s
Run = Callable[[Goal], Ended]


def relayed(nodes: tuple[Ros, Ros], run: Run, accept: Callable[[Any], Reason | None] | None = None) -> Any:
    """A client of a relay in front of a server; both ends are in one node, the relay in the other."""
    between, ends = nodes
    near, far = f"/m{uuid4().hex}/swing", f"/m{uuid4().hex}/rc/swing"
    ends.serve(SetSwingAngle, far, run, accept)
    peer = between.peer(SetSwingAngle, far)
    relay = Relay("m", SetSwingAngle, peer)
    between.serve(SetSwingAngle, near, relay.run, relay.accept)
    client = ends.peer(SetSwingAngle, near)
    wait_until(lambda: peer.ready() and client.ready(), LIMIT, "the servers")
    return client


def ended(call: Call) -> Outcome | None:
    wait_until(lambda: call.outcome is not None, LIMIT, "the end of the goal")
    return call.outcome


def test_goal_feedback_and_result_are_passed_on_with_the_uuid(two_nodes: tuple[Ros, Ros]) -> None:
    seen: list[tuple[bytes, float]] = []

    def run(goal: Goal) -> Ended:
        seen.append((goal.uuid, goal.request.target_angle))
        goal.publish(SetSwingAngle.Feedback(current_error=0.25))
        return Outcome.SUCCEEDED, SetSwingAngle.Result(success=True)

    angles: list[float] = []
    client = relayed(two_nodes, run)
    call = client.send(SetSwingAngle.Goal(target_angle=0.5), on_feedback=lambda told: angles.append(told.current_error))
    assert ended(call) is Outcome.SUCCEEDED
    assert call.result.success and seen == [(call.id, 0.5)] and angles == [0.25]


def test_a_cancel_reaches_the_other_server(two_nodes: tuple[Ros, Ros]) -> None:
    begun = threading.Event()

    def run(goal: Goal) -> Ended:
        begun.set()
        assert goal.cancelled.wait(LIMIT)
        return Outcome.CANCELED, SetSwingAngle.Result()

    client = relayed(two_nodes, run)
    call = client.send(SetSwingAngle.Goal())
    assert begun.wait(LIMIT)
    client.cancel(call)
    assert ended(call) is Outcome.CANCELED


def test_what_the_other_server_refuses_is_aborted(two_nodes: tuple[Ros, Ros]) -> None:
    def never(goal: Goal) -> Ended:
        raise AssertionError("a refused goal is never run")

    client = relayed(two_nodes, never, lambda _: Busy("m:rc"))
    assert ended(client.send(SetSwingAngle.Goal())) is Outcome.ABORTED


def test_without_the_other_server_a_goal_is_refused(two_nodes: tuple[Ros, Ros]) -> None:
    between, ends = two_nodes
    near = f"/m{uuid4().hex}/swing"
    relay = Relay("m", SetSwingAngle, between.peer(SetSwingAngle, "/nobody/swing"))
    between.serve(SetSwingAngle, near, relay.run, relay.accept)
    client = ends.peer(SetSwingAngle, near)
    wait_until(client.ready, LIMIT, "the relay")
    assert ended(client.send(SetSwingAngle.Goal())) is Outcome.REJECTED
