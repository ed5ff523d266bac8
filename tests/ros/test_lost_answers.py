"""A goal whose answer gets lost: a server that has not yet discovered its client drops what it says to it."""

import threading
from types import SimpleNamespace
from typing import Any

import pytest
from action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray
from rclpy.task import Future
from tms_msg_rc.srv import StopMachine
from tms_msg_ts.action import LeafNodeBase
from tms_msg_ts.srv import ResumePlan

from conftest import wait_until
from tms_decision.leaf.replay import Replay
from tms_reason.reason import Foreign
from tms_ros.client import Peer
from tms_ros.goals import Outcome
from tms_ros.node import Ros
from tms_ts.machines import Identity, Machines

pytestmark = pytest.mark.ros
LIMIT = 20.0  # s for whatever must happen at all
NAME = "/silent/change_pose"


class Silent:
    """An action server made of its parts, whose answer to a goal never arrives."""

    def __init__(self, ros: Ros, *, takes_goals: bool) -> None:
        self.asked: list[bytes] = []  # goal ids
        self.cancelled: list[bytes] = []
        self._takes_goals = takes_goals
        self._result: Any = Future()
        impl, prefix = LeafNodeBase.Impl, f"{NAME}/_action"
        for kind, name, handler in (
            (impl.SendGoalService, "send_goal", self._never_answers),
            (impl.GetResultService, "get_result", self._results),
            (impl.CancelGoalService, "cancel_goal", self._cancel),
        ):
            ros.node.create_service(kind, f"{prefix}/{name}", handler, callback_group=ros.loop.group)
        self._feedback = ros.publisher(impl.FeedbackMessage, f"{prefix}/feedback")
        self._status = ros.publisher(GoalStatusArray, f"{prefix}/status", depth=1, latched=True)

    async def _never_answers(self, request: Any, response: Any) -> Any:
        self.asked.append(bytes(request.goal_id.uuid))
        if self._takes_goals:
            info = GoalInfo(goal_id=request.goal_id)
            accepted = GoalStatus(goal_info=info, status=GoalStatus.STATUS_EXECUTING)
            self._status.publish(GoalStatusArray(status_list=[accepted]))
        await Future()
        return response

    async def _results(self, _request: Any, response: Any) -> Any:
        if self._takes_goals:
            await self._result
            response.status = GoalStatus.STATUS_SUCCEEDED
        return response  # without a status the goal is unknown

    def _cancel(self, request: Any, response: Any) -> Any:
        self.cancelled.append(bytes(request.goal_info.goal_id.uuid))
        return response

    def finish(self) -> None:
        self._result.set_result(None)


def peer_of(client: Ros) -> Peer:
    peer = client.peer(LeafNodeBase, NAME)
    wait_until(peer.ready, LIMIT, "server found")
    return peer


def test_the_status_tells_that_a_goal_was_accepted(two_nodes: tuple[Ros, Ros]) -> None:
    silent = Silent(two_nodes[0], takes_goals=True)
    call = peer_of(two_nodes[1]).send(LeafNodeBase.Goal(model_name="zx200", record_name="A"))
    wait_until(lambda: call.accepted, LIMIT, "goal known as accepted")
    assert silent.asked == [call.id]
    assert call.outcome is None
    two_nodes[0].on_executor(silent.finish)
    wait_until(lambda: call.outcome is Outcome.SUCCEEDED, LIMIT, "result")


def test_a_stop_asked_of_a_gateway_that_is_being_lost_is_asked_of_its_successor(two_nodes: tuple[Ros, Ros]) -> None:
    asked = []
    alive = threading.Event()
    alive.set()

    def gateway(_: Any, answer: Any) -> Any:
        """Killed after the first request has reached it; its successor answers."""
        asked.append(alive.is_set())
        if len(asked) == 1:
            alive.clear()
            return None
        answer.receipt.confirmed = True
        return answer

    two_nodes[0].offer_slow(StopMachine, "/zx200/rc/stop", gateway)
    back = lambda machine, seconds: alive.set()  # noqa: E731
    gateways = SimpleNamespace(wait_alive=back, loss=lambda machine: lambda: not alive.is_set())
    identity = Identity(1, 3, SimpleNamespace(), Replay([]))  # type: ignore[arg-type]
    machines = Machines(two_nodes[1], None, None, gateways, lambda: None, lambda *_: None, identity)  # type: ignore[arg-type]
    assert machines.stops.stop("zx200", Foreign("test")).confirmed
    assert asked == [True, True]


def test_a_goal_that_the_server_does_not_know_is_lost(two_nodes: tuple[Ros, Ros]) -> None:
    silent = Silent(two_nodes[0], takes_goals=False)
    peer = peer_of(two_nodes[1])
    call = peer.send(LeafNodeBase.Goal(model_name="zx200", record_name="A"))
    wait_until(lambda: silent.asked == [call.id], LIMIT, "goal at the server")
    assert not call.accepted
    assert call.outcome is None
    peer.resolve_unanswered(call)
    wait_until(lambda: call.outcome is Outcome.LOST, LIMIT, "goal known as lost")
    wait_until(lambda: silent.cancelled == [call.id], LIMIT, "cancel, should it come after all")


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_a_bug_in_a_slow_service_is_no_success(two_nodes: tuple[Ros, Ros]) -> None:
    def broken(_: Any, answer: Any) -> Any:
        answer.task_id = 7
        raise RuntimeError("a bug")

    two_nodes[0].offer_slow(ResumePlan, "/broken", broken)
    answer = two_nodes[1].call(ResumePlan, "/broken", ResumePlan.Request(), LIMIT)
    assert (answer.error_code, answer.task_id) == ("INTERNAL", 0)
