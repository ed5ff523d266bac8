"""What a gateway wants to be done. A shell does it in the order of the list, at once."""

from dataclasses import dataclass, field
from typing import Any

from tms_reason.reason import Reason


@dataclass(frozen=True)
class Receipt:
    """What a stop has shown."""

    cause: Reason
    stamp: float  # s since 1970, when it began
    run: int
    latched: bool
    confirmed: bool = False
    seconds: float = 0.0
    joint: str = ""
    angle: float = 0.0  # rad
    way: float = 0.0  # m
    detail: Reason | None = None
    evidence: Reason | None = None


# fmt: off
# commands to the machine
@dataclass(frozen=True)
class Zero: pass  # velocity
@dataclass(frozen=True)
class Emergency: on: bool  # press or release its own emergency stop
@dataclass(frozen=True)
class CancelAll: pass  # the goals of all clients at its servers
@dataclass(frozen=True)
class Send: number: int  # a goal to its server
@dataclass(frozen=True)
class Cancel: number: int  # a goal that was sent, also before its acceptance
@dataclass(frozen=True)
class GiveUp: number: int  # a goal that its server has not answered
@dataclass(frozen=True)
class Lose: number: int  # end a goal whose server is gone: no other process ends it

# answers; a goal's outcome is one of tms_ros.goals, and without `why` the result of the machine's server says it
@dataclass(frozen=True)
class End: number: int; outcome: str; why: Reason | None = None
@dataclass(frozen=True)
class Stopped: request: int; receipt: Receipt
@dataclass(frozen=True)
class Rearmed:
    request: int; cause: Reason | None = None; token: str = ""; armed: bool = False; wrong: Reason | None = None
@dataclass(frozen=True)
class Taken: request: int; wrong: Reason | None = None

# the disk, in this order; each is answered by an event
@dataclass(frozen=True)
class KeepState: number: int; latched: Reason | None; holder: str; run: int  # who may move it; empty: no run or client
@dataclass(frozen=True)
class KeepDriver: number: int; who: str  # who drives the machine by hand; empty: no person does
@dataclass(frozen=True)
class KeepReceipt: stop: int; receipt: Receipt

# what others see, and what the shell sees
@dataclass(frozen=True)
class Publish: pass  # the state, now
@dataclass(frozen=True)
class Look: pass  # beat at once
@dataclass(frozen=True)
class Tell: receipt: Receipt
@dataclass(frozen=True)
class Log: event: str; values: dict[str, Any] = field(default_factory=dict); warning: bool = True
# fmt: on

Effect = (
    Zero | Emergency | CancelAll | Send | Cancel | GiveUp | Lose | End | Stopped | Rearmed | Taken | KeepState
    | KeepDriver | KeepReceipt | Publish | Look | Tell | Log
)  # fmt: skip
