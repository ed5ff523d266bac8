"""Goals for a machine: send one, wait for its end, a cancel or the time-out, stop motions that still run."""

import threading
from collections.abc import Callable, Mapping
from typing import Any

from tms_config.clock import monotonic
from tms_config.models import Joint, MachineModel
from tms_config.naming import process_of
from tms_decision import STOP_PROVEN
from tms_decision.reasons import ProcessLost
from tms_interfaces.generated import ActionType, F, G, R
from tms_kit.yard import Yard
from tms_machine.reasons import (
    Aborted,
    Canceled,
    ErrorNumber,
    GoalTimeout,
    Missed,
    NoCapability,
    NoReason,
    NoSuchJoint,
    Rejected,
)
from tms_reason import wire
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason, Several
from tms_ros.client import AnyCall, AnyPeer
from tms_ros.goals import Outcome
from tms_ros.node import Ros
from tms_ros.reasons import LostMeanwhile, NoAnswer
from tms_runtime.fence import derived

SERVER_LIMIT = 5.0  # s for an action server to appear
ACCEPT_LIMIT = 3.0  # s for the server to answer a goal
MOTION_END_LIMIT = STOP_PROVEN + 2.5  # s for a cancelled motion to end
SERVER_CHECK_PERIOD = 0.2  # s between checks whether the server is still there
UNANSWERED_LIMIT = 1.0  # s for a goal to be accepted after all
REQUEST = "request_wait_ur"  # asks a person; as the C++ system's version 6 calls it; the scheduler serves it

Progress = Callable[[Reason | str], None]  # a subtask's own texts are shown as they are
ENDED = {Outcome.ABORTED: Aborted, Outcome.CANCELED: Canceled, Outcome.REJECTED: Rejected}


class SubtaskCancelled(Exception):
    """The goal was cancelled while it waited; raised by every waiting call of a Machine."""


class Acting:
    """The base of every capability. The runtime stops motions that still run when the goal ends."""

    def __init__(
        self,
        ros: Ros,
        name: str,
        model_name: str,
        model: MachineModel,
        timeout: float,
        goal_id: bytes = b"",
        watches: Mapping[str, Callable[[AnyPeer], None]] | None = None,
        yard: Callable[[], Yard] | None = None,
    ) -> None:
        """`goal_id`: of the subtask's goal; `watches` end calls to rc and rp when those processes are lost.

        `yard`: makes what `yard` is, once a subtask asks for it.
        """
        self._goal_id, self._watches, self._yard = goal_id, watches or {}, yard
        self.name = name
        self.model = model
        self._ros, self._model_name, self._timeout = ros, model_name, timeout
        self._deadline = monotonic() + timeout
        self._cancelled = threading.Event()
        self._calls: list[tuple[AnyPeer, AnyCall]] = []

    @property
    def yard(self) -> Yard:
        """What is around the machine."""
        assert self._yard is not None, "a subtask has a site"
        return self._yard()

    def joint(self, name: str) -> Joint:
        """Limits of a joint.

        Raises:
            SubtaskFailed: the machine has no such joint.
        """
        if name not in self.model.joints:
            raise SubtaskFailed(NoSuchJoint(name, tuple(self.model.joints)))
        return self.model.joints[name]

    def cancel(self) -> None:
        """End the call that waits, with SubtaskCancelled. Called by the runtime."""
        self._cancelled.set()
        for _, call in self._calls:
            call.changed()

    def check(self) -> None:
        """Raise when the goal was cancelled or has run out of time; for subtasks that compute for long.

        Raises:
            SubtaskCancelled: a cancel came.
            SubtaskFailed: GoalTimeout.
        """
        if self._cancelled.is_set():
            raise SubtaskCancelled
        if monotonic() > self._deadline:
            raise SubtaskFailed(GoalTimeout(self.name, self._timeout))

    def act(
        self, action_type: ActionType[G, R, F], action: str, goal: G, received: Callable[[F], None] | None = None
    ) -> R:
        """Send a goal to an action of this machine and wait for its result.

        Raises:
            SubtaskCancelled, SubtaskFailed: it was cancelled, did not fit, or ran out of time.
        """
        peer = self._ros.peer(action_type, f"/{self.name}/{action}")
        peer.wait_ready(SERVER_LIMIT)
        self.check()
        if (watch := self._watches.get(_process_of(action))) is not None:
            watch(peer)
        call = peer.send(goal, goal_id=derived(self._goal_id), on_feedback=received)
        self._calls.append((peer, call))
        self._wait(peer, call, lambda: call.accepted or call.outcome is not None, ACCEPT_LIMIT, action)
        self._wait(peer, call, lambda: call.outcome is not None, None, action)
        if call.outcome is Outcome.LOST:
            raise SubtaskFailed(ProcessLost(LostMeanwhile(process_of(peer.name), peer.name)))
        if call.outcome is not Outcome.SUCCEEDED:
            raise SubtaskFailed(ENDED[call.outcome or Outcome.ABORTED](_why(call), peer.name))
        assert call.result is not None, "a goal that succeeded has a result"
        return call.result

    def guarded(self, field: str, action_type: ActionType[G, R, F], goal: G, received: Callable[[F], None]) -> R:
        """`act` on one of the machine's own motions, by its key under borders:, through the gateway.

        Raises:
            SubtaskCancelled, SubtaskFailed: as `act`, and NoCapability.
        """
        if not any(getattr(border, field) for border in self.model.borders.values()):
            raise SubtaskFailed(NoCapability(self.name, field, self._model_name))
        return self.act(action_type, f"rc/{field}", goal, received)

    def _wait(self, peer: AnyPeer, call: AnyCall, done: Callable[[], bool], limit: float | None, action: str) -> None:
        end = self._deadline if limit is None else min(self._deadline, monotonic() + limit)
        while not (done() or self._cancelled.is_set()) and monotonic() < end:
            call.wait_for(lambda: done() or self._cancelled.is_set(), min(SERVER_CHECK_PERIOD, end - monotonic()))
            if call.accepted and call.outcome is None and peer.left():
                peer.mark_lost()  # it ended in order, but without a result
        if not done():
            self.check()
            raise SubtaskFailed(NoAnswer(process_of(peer.name), peer.name, limit or 0.0))

    def release(self) -> bool:
        """Stop every motion that still runs and wait for its end; False if no end was reported."""
        running = [(peer, call) for peer, call in self._calls if call.outcome is None]
        for peer, call in running:
            peer.cancel(call)
        deadline = monotonic() + MOTION_END_LIMIT
        # A goal without acceptance moves no machine: if it is accepted after all, its cancel follows at once.
        accepted = [call for _, call in running if call.wait_for(_known(call), UNANSWERED_LIMIT) and call.accepted]
        ended = [call.wait_for(_ended(call), deadline - monotonic()) for call in accepted]
        return all(ended) and not any(call.outcome is Outcome.LOST for call in accepted)


def missed(result: Any) -> list[int]:
    """The missed waypoints of a FollowWaypoints result; Humble gives numbers, Jazzy messages."""
    return [int(getattr(one, "index", one)) for one in getattr(result, "missed_waypoints", ())]


def _known(call: AnyCall) -> Callable[[], bool]:
    return lambda: call.accepted or call.outcome is not None


def _ended(call: AnyCall) -> Callable[[], bool]:
    return lambda: call.outcome is not None


def _why(call: AnyCall) -> Reason:
    """The reason that a result or the last feedback gives; results of Humble's Nav2 have none."""
    state = getattr(call.feedback, "state", "") or getattr(call.feedback, "status", "")
    reported = wire.of(getattr(call.result, "error_string", "") or getattr(call.result, "error_msg", "") or state)
    number, lost = getattr(call.result, "error_code", 0), missed(call.result)
    if reported is None and isinstance(number, int) and number:
        reported = ErrorNumber(number)
    if lost:
        waypoints = Missed(tuple(lost))
        return waypoints if reported is None else Several((waypoints, reported))
    return reported or NoReason()


def _process_of(action: str) -> str:
    """Whose loss ends a call: the gateway's, the scheduler's or, for all other actions, the planner's."""
    return "rc" if action.startswith("rc/") else "ts" if action == REQUEST else "rp"
