"""A machine of one joint: its true motion, its server, and what it tells of itself. Pure; times are its own seconds."""

from collections import deque
from dataclasses import dataclass, field

from tms_proof.facts import JointFacts, MachineFacts, ResponseFacts, SourceFacts, StillFacts
from tms_proof.source import SourceSample
from tms_proof.standstill import JOINTS

JOINT, PASSIVE = "boom", "bucket"
PLACE = 0.5  # rad, where the passive joint is
DEAD_TIME, LAG, TOP = 0.3, 0.1, 0.5  # s, s, rad/s
PERIOD = 0.1  # s between messages
RECORD = 20  # messages that it can tell again


def facts(name: str = "zx200", at_once: bool = False, passive: bool = False) -> MachineFacts:
    """What the decisions know of it; `passive`: it has a second joint, which no command moves."""
    joints = {one: JointFacts(TOP, -9.0, 9.0) for one in ((JOINT, PASSIVE) if passive else (JOINT,))}
    return MachineFacts(
        name, joints, {JOINT: ResponseFacts(DEAD_TIME, LAG, 0.1)},
        StillFacts(0.01, 0.02, 0.01, 0.2), {JOINTS: SourceFacts(PERIOD, "utc", 2.0, f"/{name}/{JOINTS}")},
        stops_at_once=at_once,
    )  # fmt: skip


@dataclass
class Fault:
    """How it is unkind."""

    coast: float = 0.0  # s that it goes on after an order to stop
    ignore_cancel: bool = False
    ignore_emergency: bool = False
    mute: bool = False  # tells nothing
    frozen_stamp: bool = False  # tells the same again and again
    zero_velocity: bool = False  # tells velocity 0
    replay: bool = False  # tells its last two seconds again and again
    silent_server: bool = False  # does not answer
    mute_joint: bool = False  # tells nothing of the joint that moves
    second_publisher: bool = False  # another one says that it stands


@dataclass
class Plant:
    """Speeds are commands on their way: each takes effect a dead time later, those of a stop at once if it can."""

    at_once: bool = False
    passive: bool = False  # it has a second joint, which does not move
    fault: Fault = field(default_factory=Fault)
    angle: float = 0.0  # rad
    speed: float = 0.0  # rad/s
    at: float = 0.0  # s
    coming: list[tuple[float, float]] = field(default_factory=list)  # when, speed
    goal: int | None = None
    until: float = 0.0  # when the goal's motion ends
    emergency: bool = False
    turned: float = float("-inf")  # when a person last began to move it
    number: int = 0  # of its messages
    others: int = 0  # messages of a second publisher
    told: deque[tuple[float, float, float]] = field(default_factory=lambda: deque(maxlen=RECORD))  # stamp, angle, speed
    frozen: tuple[float, float, float] | None = None  # what it repeats

    def advance(self, now: float) -> None:
        """Let time pass."""
        while self.coming and self.coming[0][0] <= now:
            when, speed = self.coming.pop(0)
            self.angle += self.speed * (when - self.at)
            self.at, self.speed = when, speed
        self.angle += self.speed * (now - self.at)
        self.at = now

    def moves(self) -> bool:
        """Whether it moves, or is on its way to."""
        return self.speed != 0.0 or any(speed != 0.0 for _, speed in self.coming)

    def accept(self, goal: int, seconds: float, speed: float, now: float) -> bool:
        """Take a goal: to turn at a speed for some seconds."""
        self.advance(now)
        if self.emergency or self.goal is not None:
            return False
        self.goal, self.until = goal, now + seconds + DEAD_TIME
        self.coming = sorted([*self.coming, (now + DEAD_TIME, speed), (self.until, 0.0)])
        return True

    def turn(self, speed: float, now: float, seconds: float) -> None:
        """A person moves it by its levers, without dead time."""
        self.advance(now)
        self.turned = now
        self.coming = sorted([*self.coming, (now, speed), (now + seconds, 0.0)])

    def halt(self, now: float, by_emergency: bool = False) -> int | None:
        """Obey an order to stop; returns the goal that it ends."""
        self.advance(now)
        ignored = self.fault.ignore_emergency if by_emergency else self.fault.ignore_cancel
        if ignored:
            return None
        wait = 0.0 if by_emergency and self.at_once else DEAD_TIME
        effect = now + wait + self.fault.coast
        self.coming = [one for one in self.coming if one[0] < effect]
        if (self.coming[-1][1] if self.coming else self.speed) != 0.0:  # else it will stand anyway
            self.coming.append((effect, 0.0))
        ended, self.goal = self.goal, None
        self.advance(now)
        return ended

    def done(self, now: float) -> int | None:
        """The goal that has ended by itself."""
        if self.goal is None or now < self.until:
            return None
        ended, self.goal = self.goal, None
        return ended

    def tell(self, now: float, clock: float = 1e9) -> SourceSample | None:
        """Its message at this moment; `clock`: what its stamps are ahead [s]."""
        self.advance(now)
        if self.fault.mute:
            return None
        stamp, angle, speed = now, self.angle, 0.0 if self.fault.zero_velocity else self.speed
        if self.fault.replay and len(self.told) == RECORD:
            _, angle, speed = self.told[self.number % RECORD]
        else:
            self.told.append((stamp, angle, speed))
        self.frozen = (self.frozen or (stamp, angle, speed)) if self.fault.frozen_stamp else None
        stamp, angle, speed = self.frozen or (stamp, angle, speed)
        self.number += 1
        seen = None if self.fault.mute_joint else (angle, speed)
        return self._sample(now, stamp + clock, self.number, seen)

    def other(self, now: float, clock: float) -> SourceSample | None:
        """The message of a second publisher, which says that it stands where it is."""
        if not self.fault.second_publisher:
            return None
        self.advance(now)
        self.others += 1
        return self._sample(now, now + clock, self.others, (self.angle, 0.0))

    def _sample(self, now: float, stamp: float, number: int, seen: tuple[float, float] | None) -> SourceSample:
        """A message with this angle and speed, or without the joint that moves."""
        found = {JOINT: seen} if seen is not None else {}
        found |= {PASSIVE: (PLACE, 0.0)} if self.passive else {}
        places = {name: (angle,) for name, (angle, _) in found.items()}
        return SourceSample(now, stamp, number, places, {name: speed for name, (_, speed) in found.items()})
