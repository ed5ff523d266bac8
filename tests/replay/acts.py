"""The words of plans: what people do, what befalls processes and machines, and the moments at which that happens.

A plan is carried out in the simulation (simulated.py) and on real processes (real.py); both know all words.
"""

from dataclasses import dataclass
from enum import Enum

GATEWAY, PLANNER, SUBTASK, SCHEDULER, HOST = "rc", "rp", "subtask", "ts", "host"


class Fault(Enum):
    """A fault of a machine."""

    COASTS = "goes on for two seconds after every order to stop"
    IGNORES_STOPS = "does not obey any order to stop"
    SILENT = "tells nothing of its joints"
    FROZEN_STAMPS = "repeats its last message"


# moments


@dataclass(frozen=True)
class AtOnce:
    """Right after the last act."""


@dataclass(frozen=True)
class Moves:
    """The goal of this number, from 1, moves the machine."""

    machine: str
    goal: int = 1


@dataclass(frozen=True)
class Over:
    """The run has ended, or is interrupted, as often as it was begun."""

    run: str


@dataclass(frozen=True)
class Answered:
    """Whoever has asked has an answer."""


Moment = AtOnce | Moves | Over | Answered


# acts


@dataclass(frozen=True)
class Start:
    """Start a run, which swings the machine to these sides, one after the other."""

    run: str
    machine: str
    leaves: tuple[str, ...] = ("left", "right")


@dataclass(frozen=True)
class Cancel:
    """Cancel a run."""

    run: str


@dataclass(frozen=True)
class Resume:
    """Resume a run that was interrupted."""

    run: str


@dataclass(frozen=True)
class Press:
    """Press the stop button for a moment."""


@dataclass(frozen=True)
class Rearm:
    """Re-arm a machine, in both steps."""

    machine: str


@dataclass(frozen=True)
class AskToMove:
    """Ask a gateway for a motion as a client without a run."""

    machine: str


@dataclass(frozen=True)
class Take:
    """Take a machine, to drive it by hand."""

    machine: str


@dataclass(frozen=True)
class GiveBack:
    """Give a machine back that was driven by hand."""

    machine: str


@dataclass(frozen=True)
class Kill:
    """Kill processes at the same time; they are started again."""

    machine: str
    processes: tuple[str, ...]


@dataclass(frozen=True)
class Freeze:
    """Freeze processes at the same time, for some seconds."""

    machine: str
    processes: tuple[str, ...]
    seconds: float


@dataclass(frozen=True)
class Restart:
    """Restart a process in order."""

    machine: str
    process: str


@dataclass(frozen=True)
class BeUnkind:
    """The machine gets a fault; none: it is in order again."""

    machine: str
    fault: Fault | None


@dataclass(frozen=True)
class StallDisk:
    """Nothing gets onto the disk for some seconds."""

    seconds: float


Act = (
    Start | Cancel | Resume | Press | Rearm | AskToMove | Take | GiveBack | Kill | Freeze | Restart | BeUnkind
    | StallDisk
)  # fmt: skip
Question = Rearm | AskToMove | Take | GiveBack  # these have an answer


@dataclass(frozen=True)
class Step:
    """An act, some seconds after a moment."""

    moment: Moment
    seconds: float
    act: Act


@dataclass(frozen=True)
class Plan:
    """Acts one after the other; it is over some time after its last moment."""

    name: str
    steps: tuple[Step, ...]
    end: Moment
