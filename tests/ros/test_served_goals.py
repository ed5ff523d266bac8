"""What a server keeps of a goal that has ended: nothing, or its trajectories would wait for the cycle collector."""

import gc
import weakref
from collections.abc import Iterator

import pytest
from tms_msg_ts.action import LeafNodeBase

from conftest import wait_until
from tms_core.ros import Ended, Goal, Outcome, Ros

pytestmark = pytest.mark.ros
LIMIT = 20.0  # s for whatever must happen at all
NAME = "/zx200/change_pose"


@pytest.fixture
def no_collector() -> Iterator[None]:
    gc.disable()
    yield
    gc.enable()


@pytest.mark.usefixtures("no_collector")
@pytest.mark.parametrize("cancel", [False, True])
def test_a_goal_is_freed_with_its_end(two_nodes: tuple[Ros, Ros], cancel: bool) -> None:
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

    server.serve(LeafNodeBase, NAME, run)
    peer = client.peer(LeafNodeBase, NAME)
    wait_until(peer.ready, LIMIT, "server found")
    call = peer.send(LeafNodeBase.Goal(model_name="zx200", record_name="A"))
    if cancel:
        wait_until(lambda: bool(goals), LIMIT, "goal at work")
        peer.cancel(call)
    wait_until(lambda: call.outcome is not None, LIMIT, "end of the goal")
    assert call.outcome is (Outcome.CANCELED if cancel else Outcome.SUCCEEDED)
    wait_until(lambda: goals[0]() is None, LIMIT, "goal freed without the cycle collector")
    assert stopped == ([call.id] if cancel else [])
