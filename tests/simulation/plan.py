"""What goes wrong in a schedule, and when: plain data from one seed, so that a schedule can be made shorter."""

import random
from dataclasses import dataclass

from simulation.plant import Fault
from simulation.site import ROLES

SECONDS = 22.0  # s of virtual time of a schedule
QUIET = 6.0  # s at the end in which nothing new goes wrong
EFFECTS = (  # of gateways and of leaf goals
    "Send", "Send", "Send", "Zero", "Emergency", "CancelAll", "Publish", "KeepState", "KeepReceipt", "Tell", "End",
    "KeepSent", "KeepDone", "StopMachine",
)  # fmt: skip
LIES: tuple[dict[str, float | bool], ...] = (
    {"coast": 1.5}, {"ignore_cancel": True}, {"mute": True}, {"frozen_stamp": True}, {"zero_velocity": True},
    {"replay": True}, {"coast": 2.0, "zero_velocity": True}, {"coast": 2.0, "frozen_stamp": True},
    {"coast": 2.5, "replay": True}, {"coast": 2.0, "mute": True}, {"silent_server": True}, {"ignore_emergency": True},
    {"ignore_cancel": True, "ignore_emergency": True},
)  # fmt: skip


@dataclass(frozen=True)
class Kill:
    """Processes are killed together; each is started again after a time of its own [s]."""

    processes: tuple[str, ...]
    again: tuple[float, ...]


@dataclass(frozen=True)
class Freeze:
    """Processes are frozen together."""

    processes: tuple[str, ...]
    seconds: float


@dataclass(frozen=True)
class Lie:
    """The machine is unkind for a while."""

    fault: Fault
    seconds: float


@dataclass(frozen=True)
class Stall:
    """The gateway's disk stalls, or is full, for a while."""

    seconds: float
    full: bool


@dataclass(frozen=True)
class Press:
    """An operator presses the button, and releases it after some seconds."""

    seconds: float


@dataclass(frozen=True)
class Rearm:
    """An operator re-arms the machine."""


@dataclass(frozen=True)
class Take:
    """A person takes the machine, moves it by its levers for some seconds, and gives it back."""

    seconds: float


@dataclass(frozen=True)
class Trapped:
    """A process is killed at the next effect of a kind: at this very moment, or some time after it [s]."""

    effect: str
    process: str
    delay: float
    again: float  # s until it is started again


@dataclass(frozen=True)
class Hang:
    """The threads of the scheduler's runs hang for a while, and the process does not."""

    seconds: float


@dataclass(frozen=True)
class Cancel:
    """An operator cancels a run."""


@dataclass(frozen=True)
class Resume:
    """An operator resumes an interrupted run, if there is one."""


@dataclass(frozen=True)
class Restart:
    """A process is restarted in order (`tms restart`)."""

    process: str


@dataclass(frozen=True)
class Clock:
    """A clock is set: of the machine, or of its gateway's PC."""

    machine: bool
    seconds: float


@dataclass(frozen=True)
class SecondGateway:
    """Somebody starts a second gateway of the machine; they find each other after a while."""

    seconds: float


@dataclass(frozen=True)
class Levers:
    """Somebody moves the machine by its levers for some seconds, and tells nobody."""

    seconds: float


@dataclass(frozen=True)
class Stranger:
    """A stranger cancels all goals at the machine."""


@dataclass(frozen=True)
class ForeignGoal:
    """A client without a run asks for a motion."""

    seconds: float


Act = (
    Kill | Freeze | Lie | Stall | Press | Rearm | Take | Cancel | Resume | Restart | Clock | SecondGateway | Stranger
    | ForeignGoal | Trapped | Hang | Levers
)  # fmt: skip


@dataclass(frozen=True)
class Planned:
    """One thing that goes wrong."""

    at: float  # s
    unit: int  # the machine that it is about
    act: Act

    def __str__(self) -> str:
        return f"{self.at:7.3f}  m{self.unit}  {self.act}"


HELPERS = (Rearm(), Rearm(), Rearm(), Resume(), Resume())  # people who put in order what has gone wrong
PEOPLE = len(HELPERS)


def machines(seed: int) -> int:
    """How many machines the site of this seed has."""
    return (1, 1, 1, 1, 1, 1, 2, 2, 2, 3)[random.Random(f"site {seed}").randrange(10)]


def passive(seed: int) -> bool:
    """Whether its machines have a second joint, which no command moves."""
    return seed % 5 == 0


def plan(seed: int) -> list[Planned]:
    """What goes wrong with this seed: at least two faults, and people who re-arm."""
    chance = random.Random(f"plan {seed}")
    last = SECONDS - QUIET
    kinds = (_kill, _kill, _kill, _freeze, _freeze, _lie, _lie, _stall, _press, _take, _stranger, _foreign, _restart,
             _clock, _second, _cancel, _trapped, _trapped, _trapped, _hang)  # fmt: skip
    units = machines(seed)
    found = [
        Planned(1.0 + chance.random() * (last - 1.0), chance.randrange(units), chance.choice(kinds)(chance))
        for _ in range(chance.randint(2, 6))
    ]
    found += [Planned(5.0 + chance.random() * (last - 3.0), 0, act) for act in HELPERS]
    return sorted(found, key=lambda one: one.at)


def _some(chance: random.Random) -> tuple[str, ...]:
    return tuple(chance.sample(ROLES, chance.choice((1, 1, 1, 2, 3))))


def _kill(chance: random.Random) -> Act:
    some = _some(chance)
    return Kill(some, tuple(0.8 + 2.0 * chance.random() for _ in some))


def _freeze(chance: random.Random) -> Act:
    return Freeze(_some(chance), chance.choice((0.2, 0.4, 0.8, 1.5, 4.0)))


def _lie(chance: random.Random) -> Act:
    return Lie(Fault(**chance.choice(LIES)), 2.0 + 6.0 * chance.random())  # type: ignore[arg-type]


def _stall(chance: random.Random) -> Act:
    return Stall(3.0 * chance.random(), chance.random() < 0.5)


def _press(chance: random.Random) -> Act:
    return Press(0.1 + chance.random())


def _take(chance: random.Random) -> Act:
    return Take(1.0 + 3.0 * chance.random())


def _stranger(_: random.Random) -> Act:
    return Stranger()


def _foreign(chance: random.Random) -> Act:
    return ForeignGoal(0.5 + 3.0 * chance.random())


def _cancel(_: random.Random) -> Act:
    return Cancel()


def _restart(chance: random.Random) -> Act:
    return Restart(chance.choice(ROLES))


def _clock(chance: random.Random) -> Act:
    return Clock(chance.random() < 0.5, chance.choice((-3600.0, -0.4, 0.3, 5.0)))


def _second(chance: random.Random) -> Act:
    return SecondGateway(0.5 + chance.random())


def _trapped(chance: random.Random) -> Act:
    effect, process = chance.choice(EFFECTS), chance.choice((*ROLES, "rc", "ts", "ts"))
    return Trapped(effect, process, chance.choice((0.0, 0.0, 0.02, 0.5, 1.0)), 0.8 + 3.0 * chance.random())


def _hang(chance: random.Random) -> Act:
    return Hang(chance.choice((0.3, 0.8, 2.0, 4.0)))
