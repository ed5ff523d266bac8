"""One goal of one leaf node, as the tree sees it."""

from collections.abc import Callable

from tms_decision.leaf.state import GoalState, LeafGoal
from tms_reason import wire
from tms_reason.reason import Reason
from tms_ros.client import AnyCall


class SentGoal:
    """Readable from any thread; only the decisions change it."""

    def __init__(self, goal: LeafGoal, call: Callable[[], AnyCall | None], cancel: Callable[[], None]) -> None:
        """`call`: its sending that is open now; `cancel`: asks for the cancel and returns at once."""
        self._goal, self._call, self.cancel = goal, call, cancel

    @property
    def state(self) -> GoalState:
        return self._goal.state

    @property
    def reason(self) -> Reason | None:
        """Why it waits, or how it has ended."""
        return self._goal.reason

    @property
    def feedback(self) -> Reason | None:
        """The subtask's last feedback."""
        return feedback(self._call())


def feedback(call: AnyCall | None) -> Reason | None:
    """The last feedback of a sending."""
    return wire.of(getattr(call.feedback, "status", "")) if call is not None else None
