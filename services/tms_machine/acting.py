"""A machine's goals: send one, wait for its end with cancel and time-out built in, stop what still runs."""

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any

from tms_config.models import Joint, MachineModel
from tms_machine.border import STOP_PROVEN
from tms_reason.errors import SubtaskFailed
from tms_ros.client import AnyCall, AnyPeer
from tms_ros.fence import derived
from tms_ros.goals import LOST_TEXT, Outcome
from tms_ros.interface_types import ActionType, F, G, R
from tms_ros.node import Ros

SERVER_LIMIT = 5.0  # s for an action server to appear
ACCEPT_LIMIT = 3.0  # s for it to answer a goal
STOP_LIMIT = STOP_PROVEN + 2.5  # s for a cancelled motion to end
LOOK = 0.2  # s between looks whether the server is still there
UNANSWERED_LIMIT = 1.0  # s for a goal to be accepted after all

Progress = Callable[[str], None]


class Cancelled(Exception):
    """The goal was cancelled while it waited; raised by every waiting call of a Machine."""


class Acting:
    """What every capability builds on. Motions that still run when the goal ends are stopped by the runtime."""

    def __init__(
        self,
        ros: Ros,
        name: str,
        model_name: str,
        model: MachineModel,
        timeout: float,
        goal_id: bytes = b"",
        watches: Mapping[str, Callable[[AnyPeer], None]] | None = None,
    ) -> None:
        """`goal_id` is of the goal this is for; `watches` make calls to rc and rp end when those processes die."""
        self._goal_id, self._watches = goal_id, watches or {}
        self.name = name
        self.model = model
        self._ros, self._model_name, self._timeout = ros, model_name, timeout
        self._deadline = time.monotonic() + timeout
        self._cancelled = threading.Event()
        self._calls: list[tuple[AnyPeer, AnyCall]] = []

    def joint(self, name: str) -> Joint:
        """Limits of a joint.

        Raises:
            SubtaskFailed: the machine has no such joint.
        """
        if name not in self.model.joints:
            raise SubtaskFailed("NO_SUCH_JOINT", f"{self.name} has no joint '{name}'")
        return self.model.joints[name]

    def cancel(self) -> None:
        """End whatever waits, with Cancelled. Called by the runtime."""
        self._cancelled.set()
        for _, call in self._calls:
            call.changed()

    def check(self) -> None:
        """Raise when the goal was cancelled or has run out of time; for subtasks that compute for long.

        Raises:
            Cancelled: a cancel came.
            SubtaskFailed: TIMEOUT.
        """
        if self._cancelled.is_set():
            raise Cancelled
        if time.monotonic() > self._deadline:
            raise SubtaskFailed("TIMEOUT", f"{self.name} was not done after {self._timeout:.0f} s")

    def act(
        self, action_type: ActionType[G, R, F], action: str, goal: G, heard: Callable[[F], None] | None = None
    ) -> R:
        """Send a goal to an action of this machine and wait for its result.

        Raises:
            Cancelled, SubtaskFailed: it was cancelled, did not fit, or ran out of time.
        """
        peer = self._ros.peer(action_type, f"/{self.name}/{action}")
        peer.wait_ready(SERVER_LIMIT)
        self.check()
        if (watch := self._watches.get("rc" if action.startswith("rc/") else "rp")) is not None:
            watch(peer)
        call = peer.send(goal, goal_id=derived(self._goal_id), on_feedback=heard)
        self._calls.append((peer, call))
        self._wait(peer, call, lambda: call.accepted or call.outcome is not None, ACCEPT_LIMIT, action)
        self._wait(peer, call, lambda: call.outcome is not None, None, action)
        if call.outcome is Outcome.LOST:
            raise SubtaskFailed(LOST_TEXT, f"the process behind {peer.name} was lost during its goal")
        if call.outcome is not Outcome.SUCCEEDED:
            raise SubtaskFailed(call.outcome.name if call.outcome else "LOST", f"{peer.name}: {_why(call)}")
        assert call.result is not None, "a goal that succeeded has a result"
        return call.result

    def guarded(self, field: str, action_type: ActionType[G, R, F], goal: G, heard: Callable[[F], None]) -> R:
        """`act` on one of the machine's own motions, by its key under borders:, through the gateway.

        Raises:
            Cancelled, SubtaskFailed: as `act`, and NO_CAPABILITY.
        """
        if not any(getattr(border, field) for border in self.model.borders.values()):
            text = f"{self.name} has no {field}: see borders: in configs/machines/{self._model_name}.yaml"
            raise SubtaskFailed("NO_CAPABILITY", text)
        return self.act(action_type, f"rc/{field}", goal, heard)

    def _wait(self, peer: AnyPeer, call: AnyCall, done: Callable[[], bool], limit: float | None, action: str) -> None:
        end = self._deadline if limit is None else min(self._deadline, time.monotonic() + limit)
        while not (done() or self._cancelled.is_set()) and time.monotonic() < end:
            call.wait_for(lambda: done() or self._cancelled.is_set(), min(LOOK, end - time.monotonic()))
            if call.accepted and call.outcome is None and peer.left():
                peer.lost()  # it left in order, but without a result
        if not done():
            self.check()
            raise SubtaskFailed("NO_ANSWER", f"/{self.name}/{action} did not answer a goal within {limit or 0:.0f} s")

    def release(self) -> bool:
        """Stop every motion that still runs and wait until it has; False if nobody has told of its end."""
        running = [(peer, call) for peer, call in self._calls if call.outcome is None]
        for peer, call in running:
            peer.cancel(call)
        deadline = time.monotonic() + STOP_LIMIT
        # One that nobody has accepted moves nothing: if it is accepted after all, its cancel follows at once.
        accepted = [call for _, call in running if call.wait_for(_known(call), UNANSWERED_LIMIT) and call.accepted]
        ended = [call.wait_for(_ended(call), deadline - time.monotonic()) for call in accepted]
        return all(ended) and not any(call.outcome is Outcome.LOST for call in accepted)


def missed(result: Any) -> list[int]:
    """Waypoints that a FollowWaypoints result calls missed; Humble gives numbers, Jazzy messages."""
    return [int(getattr(one, "index", one)) for one in getattr(result, "missed_waypoints", ())]


def _known(call: AnyCall) -> Callable[[], bool]:
    return lambda: call.accepted or call.outcome is not None


def _ended(call: AnyCall) -> Callable[[], bool]:
    return lambda: call.outcome is not None


def _why(call: AnyCall) -> str:
    """The reason that a result or the last feedback gives; results of Humble's Nav2 have none."""
    state = getattr(call.feedback, "state", "") or getattr(call.feedback, "status", "")
    text = getattr(call.result, "error_string", "") or getattr(call.result, "error_msg", "") or state
    code = getattr(call.result, "error_code", 0)
    if not text and isinstance(code, int) and code:
        text = f"error code {code}"
    lost = missed(call.result)
    if lost:
        text = f"missed waypoints {', '.join(map(str, lost))}" + (f" ({text})" if text else "")
    return text or "no reason given"
