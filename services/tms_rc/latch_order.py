"""Has a machine stopped and latched for what others watch: once each time that it is armed, or that it happens anew."""

from collections.abc import Callable

from tms_decision.gateway.state import Gateway
from tms_reason.reason import Reason

AGAIN = 0.5  # s until a stop is asked for again that has not latched the machine yet


class LatchOrder:
    """The order of one watch, for its thread."""

    def __init__(self, gateway: Gateway, stop: Callable[[Reason], None]) -> None:
        """`stop`: has the machine stopped and latched, without waiting."""
        self._gateway, self._stop = gateway, stop
        self._latched, self._number, self._asked = False, 0, float("-inf")

    def armed(self) -> bool:
        """Whether a person has armed the machine since the last call."""
        before, self._latched = self._latched, self._gateway.latch.cause is not None
        return before and not self._latched

    def give(self, now: float, why: Reason | None, number: int = 0) -> None:
        """Give the order, if there is a reason; `number`: how often it has happened. No command opposes a person."""
        if why is None or self._gateway.by_hand is not None or now - self._asked < AGAIN:
            return
        if not self._latched or number != self._number:
            self._number, self._asked = number, now
            self._stop(why)
