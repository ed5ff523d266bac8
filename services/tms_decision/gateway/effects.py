"""What a gateway wants to be done. A shell does it in the order of the list, at once."""

from dataclasses import field
from typing import Any

from tms_decision.data import Data, Effect
from tms_reason.reason import Reason


class Receipt(Data):
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
class Zero(Effect): pass  # velocity
class Emergency(Effect): on: bool  # press or release its own emergency stop
class CancelAll(Effect): pass  # the goals of all clients at its servers
class Send(Effect): number: int  # a goal to its server
class Cancel(Effect): number: int  # a goal that was sent, also before its acceptance
class GiveUp(Effect): number: int  # a goal that its server has not answered
class Lose(Effect): number: int  # end a goal whose server is gone: no other process ends it

# answers; a goal's outcome is one of tms_ros.goals, and without `why` the result of the machine's server says it
class End(Effect): number: int; outcome: str; why: Reason | None = None
class Stopped(Effect): request: int; receipt: Receipt
class Rearmed(Effect):
    request: int; cause: Reason | None = None; token: str = ""; armed: bool = False; wrong: Reason | None = None
class Taken(Effect): request: int; wrong: Reason | None = None

# the disk, in this order; each is answered by an event; an empty name: no run or client, no person
class KeepState(Effect): number: int; latched: Reason | None; holder: str; run: int  # who may move it, if any
class KeepDriver(Effect): number: int; who: str  # who drives the machine by hand
class KeepReceipt(Effect): stop: int; receipt: Receipt

# what others see, and what the shell sees
class Publish(Effect): pass  # the state, now
class Look(Effect): pass  # beat at once
class Tell(Effect): receipt: Receipt
class Log(Effect): event: str; values: dict[str, Any] = field(default_factory=dict); warning: bool = True
# fmt: on
