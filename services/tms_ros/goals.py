"""Types for both sides of an action: how a goal ends, and whether a server accepts it."""

from collections.abc import Awaitable, Callable
from enum import Enum

from tms_interfaces.generated import G, R
from tms_reason.reason import Reason


class Outcome(Enum):
    """How a goal ended; the numbers are action_msgs/GoalStatus."""

    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6
    REJECTED = -1
    LOST = -2  # the server went away or never answered


Ended = tuple[Outcome, R]  # SUCCEEDED, CANCELED or ABORTED, and the result
# Returns why a goal is refused, which reaches the client as a feedback of that goal; None accepts it.
Accept = Callable[[G], "Reason | Awaitable[Reason | None] | None"]
