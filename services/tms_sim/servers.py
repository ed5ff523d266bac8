"""The action servers of a stand-in: each turns goals of one type into a motion of the machine, with its faults."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tms_reason.reason import Foreign, Reason
from tms_ros.goals import Ended, Outcome
from tms_ros.server import AnyGoal
from tms_runtime.app import App
from tms_sim.machine import StandIn
from tms_sim.motion import Motion, MotionVerdict

FEEDBACK = 0.1  # s


@dataclass(frozen=True)
class ActionHandler:
    """One action. `begin` gets the request; the others get the motion that `begin` returned."""

    field: str  # its key under borders:
    type: Any
    refusal: Callable[[Any], tuple[int, str] | str | None]
    begin: Callable[[Any], Any]
    cancel: Callable[[Any], None]
    feedback: Callable[[Any], Any]
    result: Callable[[Any, MotionVerdict], Any]


class ActionServer:
    """Runs the goals of one action."""

    def __init__(self, app: App, machine: StandIn, handler: ActionHandler) -> None:
        self._log, self._machine, self._handler = app.log, machine, handler

    def accept(self, request: Any) -> Reason | None:
        """Refuse an impossible goal as the real servers do: without a result, and with the reason in the log."""
        refused = self._handler.refusal(request)
        if self._handler.field in self._machine.fault.refuse:
            refused = "the fault 'refuse' is on"
        if refused is None:
            return None
        code, text = refused if isinstance(refused, tuple) else (0, refused)
        self._log.warning("refused", action=self._handler.field, code=code, reason=text)
        return Foreign(f"{code}: {text}")

    def run(self, goal: AnyGoal) -> Ended[Any]:
        """Follow one goal to its end."""
        machine, handler = self._machine, self._handler
        due = machine.time + machine.fault.late
        while machine.time < due:
            if goal.cancelled.wait(FEEDBACK / 5):
                return Outcome.CANCELED, handler.type.Result()
        motion: Motion = handler.begin(goal.request)
        goal.on_cancel = lambda: machine.cancel(lambda: handler.cancel(motion))
        if goal.cancelled.is_set():  # the request came before the motion began
            goal.on_cancel()
        while not motion.over.wait(FEEDBACK):
            if not machine.fault.drop_feedback:
                goal.publish(handler.feedback(motion))
        verdict = motion.verdict or MotionVerdict("ABORTED")
        self._log.info("ended", action=handler.field, goal=goal.id, outcome=verdict.outcome, reason=verdict.text)
        return Outcome[verdict.outcome], handler.result(motion, verdict)
