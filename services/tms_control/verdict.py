"""How a goal of joints or tracks ended."""

from dataclasses import dataclass
from enum import Enum

from tms_reason.reason import Reason

SUCCESSFUL = 0  # result code


class Ending(Enum):
    """How a goal ended, as ROS names it."""

    SUCCEEDED = "SUCCEEDED"
    CANCELED = "CANCELED"
    ABORTED = "ABORTED"


@dataclass(frozen=True)
class Verdict:
    """The end of a goal."""

    ending: Ending
    reason: Reason | None = None
    code: int = SUCCESSFUL  # of the result, where its action has one
