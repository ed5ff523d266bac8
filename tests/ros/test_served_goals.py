"""Goals that a process serves: how each ends, and what is kept of it."""

import gc
import threading
import weakref
from collections.abc import Iterator
from uuid import uuid4

import pytest
from rclpy.clock_type import ClockType
from tms_msg_ts.action import LeafNodeBase

from conftest import wait_until
from tms_decision.reasons import ProcessLost
from tms_reason.wire import to_line
from tms_ros.goals import Ended, Outcome
from tms_ros.node import Ros
from tms_ros.reasons import BeingStopped
from tms_ros.server import Goal

pytestmark = pytest.mark.ros
LIMIT = 20.0  # s for whatever must happen at all


@pytest.fixture
def name() -> str:
    """Of an action; its own for each test, since the server of the last one may still be known."""
    return f"/m{uuid4().hex}/change_pose"


@pytest.fixture
def no_collector() -> Iterator[None]:
    gc.disable()
    yield
    gc.enable()


@pytest.mark.usefixtures("no_collector")
@pytest.mark.parametrize("cancel", [False, True])
def test_a_goal_is_freed_with_its_end(two_nodes: tuple[Ros, Ros], name: str, cancel: bool) -> None:
    """Or its trajectories would wait for the cycle collector."""
    server, client = two_nodes
    goals: list[weakref.ref[Goal]] = []
    stopped: list[bytes] = []

    def run(goal: Goal) -> Ended:
        goals.append(weakref.ref(goal))
        goal.on_cancel = lambda: stopped.append(goal.uuid)  # as every subtask does: it refers to its goal
        if not cancel:
            return Outcome.SUCCEEDED, LeafNodeBase.Result(result=True)
        goal.cancelled.wait(LIMIT)
        return Outcome.CANCELED, LeafNodeBase.Result()

    server.serve(LeafNodeBase, name, run)
    peer = client.peer(LeafNodeBase, name)
    wait_until(peer.ready, LIMIT, "server found")
    call = peer.send(LeafNodeBase.Goal(model_name="zx200", record_name="A"))
    if cancel:
        wait_until(lambda: bool(goals), LIMIT, "goal at work")
        peer.cancel(call)
    wait_until(lambda: call.outcome is not None, LIMIT, "end of the goal")
    assert call.outcome is (Outcome.CANCELED if cancel else Outcome.SUCCEEDED)
    wait_until(lambda: goals[0]() is None, LIMIT, "goal freed without the cycle collector")
    assert stopped == ([call.id] if cancel else [])


def test_one_id_for_goals_of_two_actions_is_two_goals(two_nodes: tuple[Ros, Ros], name: str) -> None:
    """As odd clients send it: a cancel reaches the one that it is meant for."""
    server, client = two_nodes
    go = threading.Event()

    def long(goal: Goal) -> Ended:
        assert goal.cancelled.wait(LIMIT)
        return Outcome.CANCELED, LeafNodeBase.Result()

    def short(goal: Goal) -> Ended:
        assert go.wait(LIMIT)
        return Outcome.SUCCEEDED, LeafNodeBase.Result(result=True)

    server.serve(LeafNodeBase, name, long)
    server.serve(LeafNodeBase, f"{name}_plan", short)
    peers = [client.peer(LeafNodeBase, name), client.peer(LeafNodeBase, f"{name}_plan")]
    wait_until(lambda: all(peer.ready() for peer in peers), LIMIT, "servers found")
    goal = LeafNodeBase.Goal(model_name="zx200", record_name="A")
    calls = [peer.send(goal, goal_id=bytes(16)) for peer in peers]
    wait_until(lambda: all(call.accepted for call in calls), LIMIT, "both accepted")
    go.set()
    wait_until(lambda: calls[1].outcome is Outcome.SUCCEEDED, LIMIT, "end of the second")
    peers[0].cancel(calls[0])
    wait_until(lambda: calls[0].outcome is Outcome.CANCELED, LIMIT, "end of the first")
    assert not server.failed.is_set()


def test_a_process_that_ends_takes_no_goal_any_more(two_nodes: tuple[Ros, Ros], name: str) -> None:
    server, client = two_nodes
    begun: list[bytes] = []

    def run(goal: Goal) -> Ended:
        begun.append(goal.uuid)
        return Outcome.SUCCEEDED, LeafNodeBase.Result(result=True)

    server.serve(LeafNodeBase, name, run)
    peer = client.peer(LeafNodeBase, name)
    wait_until(peer.ready, LIMIT, "server found")
    server._served.leave(0.0)
    told: list[str] = []

    def refused() -> bool:
        """Its reason, which comes on a topic, may miss a client that is very new."""
        call = peer.send(LeafNodeBase.Goal(model_name="zx200", record_name="A"))
        wait_until(lambda: call.outcome is not None, LIMIT, "answer")
        assert call.outcome is Outcome.REJECTED
        told.extend([call.feedback.status] if call.feedback is not None else [])
        return bool(told)

    wait_until(refused, LIMIT, "reason")
    assert told == [to_line(ProcessLost(BeingStopped("server")))]
    assert begun == []


def test_timers_do_not_stand_still_when_the_time_of_the_pc_is_set_back(two_nodes: tuple[Ros, Ros]) -> None:
    assert two_nodes[0].every(1.0, lambda: None).clock.clock_type is ClockType.STEADY_TIME
