"""What both sides of an action share: how a goal ends, and what a server says of it."""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from enum import Enum

from tms_ros.interface_types import G, R

LOST_TEXT = "PROCESS_LOST"  # in the reason of a goal that ended because a process did


class Outcome(Enum):
    """How a goal ended; the numbers are action_msgs/GoalStatus."""

    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6
    REJECTED = -1
    LOST = -2  # the server went away or never answered


@dataclass(frozen=True)
class Rejection:
    """Why a goal is not accepted; `code: text` reaches the client as a feedback of that goal."""

    code: str
    text: str


Ended = tuple[Outcome, R]  # SUCCEEDED, CANCELED or ABORTED, and the result
Accept = Callable[[G], "Rejection | Awaitable[Rejection | None] | None"]
