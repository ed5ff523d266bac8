"""What happens to a gateway. Times are in the `now` of the step, unless an event says otherwise."""

from collections.abc import Sequence

from tms_decision.data import Data, Event
from tms_decision.owner import Owner
from tms_proof.source import SourceSample
from tms_reason.reason import Reason


class Left(Data):
    """How the machine was left, by the notes on the disk; `latched` is None when it was armed."""

    latched: Reason | None
    holder: str = ""  # the run or the foreign client that may have left it moving
    run: int = 0  # fencing number of that run
    taken: str = ""  # who drives it by hand
    unproven: bool = False  # it was latched, but the receipt of that stop was never written to the disk


class Beat(Event):
    """A moment has passed: 50 ms, or less while a stop is being proven. What the shell sees at it."""

    wall: float  # s since 1970, for receipts
    reachable: bool = True  # a cancel would reach all servers of the machine
    settling: bool = False  # the machine may still have commands of a stop before it, as a cancel
    ready: bool = True  # the server of the active goal is there
    gone: bool = False  # the server that took the active goal is gone
    escaped: Reason | None = None  # what has left its limits, or its areas; a ProcessLost: nobody sees whether it has


class Reference(Data):
    """A trajectory: times [s] and angles [rad] in the order of `names`."""

    names: Sequence[str]
    points: Sequence[tuple[float, Sequence[float]]]


class Turn(Data):
    """One joint goes to an angle [rad], at most this fast [rad/s, rad/s^2]: only the end of its motion is known."""

    joint: str
    angle: float
    velocity: float
    acceleration: float


class GoalAsked(Event):
    """A client asks for a motion; `number` is new for each goal."""

    number: int
    id: str  # as its client, the log and the state of the machine have it
    owner: Owner | None  # None: a foreign client
    server: str  # name of the machine's own server
    wrong: Reason | None = None  # why the machine must not do it: its limits
    motion: Reference | Turn | None = None
    lasts: float = float("inf")  # s, as the goal says


# fmt: off
# what the machine tells
class Sampled(Event): source: str; sample: SourceSample
class Published(Event): source: str; nodes: tuple[str, ...]  # who publishes it, if more than one
class Manual(Event): on: bool  # its own signal that a person drives it by its levers
class Pressed(Event): pass  # its own emergency stop, by whomever
class StoodIn(Event): pass  # the host agent has pressed it just now, in place of this gateway
class StandsIn(Event): on: bool  # the host agent commands the machine, since it misses this gateway

# permits: a process says which goal it stands behind; DDS reports how many of its writers are asserted
class PermitHeard(Event): process: str; goal: bytes; holder: str
class PermitReported(Event): process: str; alive: int; not_alive: int; late: bool  # this PC did not run just now

# goals: what their clients want, and what the machine's server does; outcome: of tms_ros.goals
class GoalCancelled(Event): number: int
class CallAccepted(Event): number: int
class CallEnded(Event): number: int; outcome: str; explained: bool = False  # its result says why

# people, the scheduler; `request` is new for each call
class Signal(Event): on: bool  # a message of /emergency_signal
class StopAsked(Event): request: int; cause: Reason | None; orderly: bool  # the end of a goal or run: no re-arm
class RearmAsked(Event): request: int; token: str; fresh: str  # without a token it asks for one, which will be `fresh`
class TakeAsked(Event): request: int; who: str; back: bool  # to drive by hand, or to give the machine back

# the disk has what was to be kept, or why it has not; and the process ends in order
class NoteKept(Event): number: int; problem: Reason | None = None
class ReceiptKept(Event): stop: int; problem: str = ""
class Leaving(Event): pass
# fmt: on
