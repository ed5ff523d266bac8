"""The state of one gateway."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import Enum

from tms_decision.gateway.effects import Effect, Log, Look, Receipt
from tms_decision.gateway.events import Beat, GoalAsked, RearmAsked, TakeAsked
from tms_decision.latch import Latch
from tms_decision.owner import Owner, parse
from tms_decision.permit_link import PermitLink
from tms_decision.vigil import Vigil
from tms_proof.facts import MachineFacts
from tms_proof.following import Follower
from tms_proof.proof import Proof
from tms_proof.standstill import StandStill
from tms_reason.reason import Reason

SCHEDULER = "ts"  # the scheduler's permit
FRESH = 0.8  # s; with older messages the machine is not ready, and a motion is stopped within a second


class Phase(Enum):
    """How far a goal is on its way to the machine; from NOTING on it is the active goal."""

    PERMIT = "waits for the processes that stand behind it"
    SETTLING = "waits for stops that are being proven, and for their cancels"
    NOTING = "waits for the note on the disk that names it"
    REACHING = "waits for the machine's server"
    HEARING = "waits for the machine's messages"
    SENT = "waits for the acceptance by the machine's server"
    MOVING = "moves the machine"


@dataclass
class Goal:
    """A goal of a client."""

    asked: GoalAsked
    since: float  # when its phase began
    start: dict[str, float] = field(default_factory=dict)  # rad, joints when it left for the machine
    phase: Phase = Phase.PERMIT
    cancelled: bool = False
    note: int = 0  # number of the note that it waits for
    beats: int = 0  # beats so far when its phase began: what they have seen may be over
    chain: dict[str, Owner] = field(default_factory=dict)  # processes that stand behind it
    sent: float = 0.0  # when it left for the machine; 0 before
    begun: float = 0.0  # when the machine's acceptance was received; 0 before
    outcome: str = ""  # at the machine's server; empty while it is open
    follower: Follower | None = None
    stop: "Stop | None" = None

    @property
    def number(self) -> int:
        return self.asked.number

    @property
    def owner(self) -> Owner | None:
        return self.asked.owner

    def enter(self, phase: Phase, now: float) -> None:
        """Go on to a phase."""
        self.phase, self.since = phase, now

    def wait_for_look(self, phase: Phase, gateway: "Gateway", now: float) -> None:
        """Go on to a phase that waits for what the next beat sees."""
        self.enter(phase, now)
        self.beats = gateway.beats
        gateway.do(Look())

    def seen(self, gateway: "Gateway") -> bool:
        """Whether a beat has looked since its phase began."""
        return gateway.beats > self.beats

    def ended(self) -> bool:
        """Whether it can no longer move the machine."""
        return not self.sent or bool(self.outcome)


@dataclass
class Stop:
    """A stop that is being proven."""

    number: int
    cause: Reason
    latched: bool
    run: int
    goal: Goal | None  # that it ends
    begun: float
    stamp: float  # s since 1970
    proof: Proof
    again: float  # when its commands are repeated
    limit: float  # when it is given up
    broken: Reason | None = None  # why it cannot be confirmed in any case: the machine had moved without a goal
    receipt: Receipt | None = None  # once it is proven, or given up
    answer: Receipt | None = None  # once the receipt is on the disk, or the disk has taken too long
    requests: list[int] = field(default_factory=list)  # calls to answer with the receipt

    @property
    def over(self) -> bool:
        """Whether it has its answer."""
        return self.answer is not None

    def ended(self) -> bool:
        """Whether the goal that it ends has ended."""
        return self.goal is None or self.goal.ended()


@dataclass
class Notes:
    """What the disk has, or will have, of the state."""

    holder: str = ""  # who may move the machine now
    run: int = 0
    asked: tuple[Reason | None, str, int] | None = None  # the state that was last written, or is being written
    number: int = 0  # of the last note
    kept: int = 0  # of the last note that the disk has answered


@dataclass
class Rearm:
    """A re-arm that waits: for a stop to be proven, or for its note."""

    asked: RearmAsked
    until: float
    note: int = 0
    closings: int = 0


@dataclass
class Doubt:
    """A press of the emergency stop, until it is known whether the host agent made it."""

    since: float  # a report of the host agent after this is about this press
    until: float


@dataclass
class Recovery:
    """The start: a motion that the last gateway may have left is stopped."""

    cause: Reason
    holder: str = ""
    run: int = 0
    unproven: bool = False
    begun: float = 0.0
    reached: bool = False  # all servers are there, or their time is over
    until: float = float("inf")
    open: bool = True  # whether it may have left a motion of a run that has not reported itself yet
    stop: Stop | None = None
    over: bool = False


@dataclass
class Gateway:
    """Everything that a gateway knows. Only `gateway.step` changes it."""

    facts: MachineFacts
    watch: StandStill
    latch: Latch
    links: dict[str, PermitLink]  # by process; the scheduler's is called `ts`
    recovery: Recovery
    vigil: Vigil = field(default_factory=Vigil)
    notes: Notes = field(default_factory=Notes)
    waiting: list[Goal] = field(default_factory=list)  # goals that are not active yet
    active: Goal | None = None
    last: tuple[Goal | None, float] = None, 0.0  # the active goal that has ended last, and when
    stops: list[Stop] = field(default_factory=list)
    numbered: int = 0  # stops so far
    rearms: list[Rearm] = field(default_factory=list)
    takes: dict[int, tuple[TakeAsked, float]] = field(default_factory=dict)  # by note, and when it was asked
    doubts: list[Doubt] = field(default_factory=list)
    run: int | None = None  # the run that holds the machine
    pressed: float = float("-inf")  # when a software stop was last received
    by_hand: Reason | None = None  # who drives the machine
    stood_in: bool = False  # the host agent has pressed the emergency stop in place of this gateway
    stood_in_at: float = float("-inf")
    standby: float = 0.0  # until then the host agent may command the machine in place of this gateway
    recovering: bool = False
    leaving: bool = False
    beat: Beat = field(default_factory=lambda: Beat(0.0))
    beat_at: float = float("-inf")
    beats: int = 0  # so far
    wall: float = 0.0  # s since 1970, less monotonic
    shown: tuple[object, ...] = ()  # the state that was last published
    shown_at: float = float("-inf")
    out: list[Effect] = field(default_factory=list)  # of this step

    def do(self, *effects: Effect) -> None:
        """Want these effects."""
        self.out.extend(effects)

    def log(self, event: str, *, warning: bool = True, **values: object) -> None:
        """Want a line in the log."""
        self.out.append(Log(event, dict(values), warning))

    def leave(self) -> None:
        """The process ends in order."""
        self.leaving = True

    def held(self, now: float) -> dict[str, Owner]:
        """The living processes, and what each stands behind."""
        links = self.links.items()
        return {name: owner for name, link in links if link.alive(now) and (owner := parse(link.goal)) is not None}

    def holder(self, now: float) -> str:
        """The name of the run that holds the machine, for people."""
        link = self.links[SCHEDULER]
        return link.holder if link.alive(now) else ""

    def silent(self, now: float) -> Reason | None:
        """Which source of the machine is silent."""
        return self.watch.silent(now, FRESH)

    def may_send(self) -> bool:
        """Whether a goal waits to be sent, or the start is under way."""
        return bool(self.waiting) or not self.recovery.over or (self.active is not None and not self.active.sent)

    def proves(self) -> bool:
        """Whether a stop waits for its proof."""
        return any(one.receipt is None for one in self.stops)

    def goals(self) -> Iterable[Goal]:
        """All goals."""
        return (*self.waiting, *([self.active] if self.active is not None else []))
