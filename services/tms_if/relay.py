"""Passes the goals of one action on to another one with the same UUID, and feedback, cancel and end back."""

from typing import Any

from tms_config.clock import monotonic
from tms_config.naming import process_of
from tms_decision import STOP_PROVEN
from tms_decision.reasons import ProcessLost
from tms_machine.reasons import MotionNotEnded
from tms_reason.reason import Reason
from tms_ros.client import AnyCall, AnyPeer
from tms_ros.goals import Ended, Outcome
from tms_ros.reasons import LostMeanwhile, NoAnswer, NoServer
from tms_ros.server import AnyGoal

ACCEPT_LIMIT = 3.0  # s for the other server to answer a goal
END_LIMIT = STOP_PROVEN + 4.0  # s for a cancelled goal to end: the subtask's own limit is 1.5 s shorter
CHECK_PERIOD = 0.2  # s between checks whether the other server is still there
ANSWERED = {Outcome.SUCCEEDED: Outcome.SUCCEEDED, Outcome.CANCELED: Outcome.CANCELED}  # all others are ABORTED


class Relay:
    """One action that this process serves in place of another one of the same type."""

    def __init__(self, machine: str, served: Any, peer: AnyPeer) -> None:
        """`served`: type of the action served here."""
        self._machine, self._served, self._peer = machine, served, peer

    def accept(self, request: Any) -> Reason | None:
        """Why a goal is refused here; the other server may still refuse it, which then aborts the goal."""
        return None if self._peer.ready() else NoServer(process_of(self._peer.name), self._peer.name, 0.0)

    def run(self, goal: AnyGoal) -> Ended[Any]:
        """Have the other server do a goal."""
        peer = self._peer
        call = peer.send(
            self.request(goal.request), goal_id=goal.uuid, on_feedback=lambda told: goal.publish(self.feedback(told))
        )
        goal.on_cancel = lambda: peer.cancel(call)
        if goal.cancelled.is_set():
            peer.cancel(call)
        why = self._waited_for(goal, call)
        if why is not None:
            goal.say(why)
        outcome = ANSWERED.get(call.outcome or Outcome.ABORTED, Outcome.ABORTED)
        return outcome, self.result(outcome, call.result)

    def request(self, request: Any) -> Any:
        """A goal as the other server takes it."""
        return request

    def feedback(self, feedback: Any) -> Any:
        """Its feedback as this action has it."""
        return feedback

    def result(self, outcome: Outcome, result: Any) -> Any:
        """Its result as this action has it; None where it gave none."""
        return self._served.Result() if result is None else result

    def _waited_for(self, goal: AnyGoal, call: AnyCall) -> Reason | None:
        """Wait for the end of a goal; why it has none, or none that its server told."""
        peer, name = self._peer, self._peer.name
        accepted_by, ended_by = monotonic() + ACCEPT_LIMIT, float("inf")
        while not call.wait_for(lambda: call.outcome is not None, CHECK_PERIOD):
            now = monotonic()
            if goal.cancelled.is_set():
                ended_by = min(ended_by, now + END_LIMIT)
            if call.accepted and peer.left():
                peer.mark_lost()
            elif not call.accepted and now > accepted_by:
                peer.resolve_unanswered(call)
                return NoAnswer(process_of(name), name, ACCEPT_LIMIT)
            elif now > ended_by:
                return MotionNotEnded(self._machine)
        return ProcessLost(LostMeanwhile(process_of(name), name)) if call.outcome is Outcome.LOST else None
