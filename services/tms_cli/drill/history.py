"""What happened in a trial, as observers saw it: `make traces` asks the model of the protocol whether that may be.

Nobody sees everything at the moment at which it happens, so each happening lies between two times.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from tms_cli.drill.plan import How, Trial
from tms_cli.drill.record import TrialRecording

FOLDER = "histories"  # in the state folder of a drill: a file for each machine, a line for each trial
CONFIRMED, UNCONFIRMED = "confirmed", "unconfirmed"
CLOCKS = 0.02  # s by which the times of two processes of one PC differ at most
ARRIVES = 0.5  # s that a message needs at most


@dataclass(frozen=True)
class Happening:
    """One thing that happened; times are s since 1970."""

    first: float
    likely: float  # between the two
    last: float
    what: str  # killed, frozen, started, pressed, accepts, receipt, run
    who: str  # a process, or the machine
    told: str = ""  # of a receipt: whether it is confirmed; of a run: the code of its state


@dataclass(frozen=True)
class Hit:
    """What was hit, and when."""

    at: float
    processes: tuple[str, ...]
    started: Mapping[str, float]  # when those that were killed were seen again
    back: float  # when they worked again


def happenings(trial: Trial, record: TrialRecording, hit: Hit, run: Iterable[tuple[float, str]]) -> list[Happening]:
    """All that is known of a trial. `run`: when its run entered which states."""
    return [
        *_of_hit(trial, hit),
        *(_stamped(one.began, "accepts", trial.machine) for one in record.goals.values()),
        *(
            Happening(one.at, one.came, one.came, "receipt", trial.machine, CONFIRMED if one.confirmed else UNCONFIRMED)
            for one in record.receipts
        ),
        *(_stamped(at, "run", "tms:ts", state) for at, state in run),
    ]


def _of_hit(trial: Trial, hit: Hit) -> list[Happening]:
    how = trial.stop.how
    if how is How.SOFTWARE:
        return [Happening(hit.at, hit.at, hit.at + ARRIVES, "pressed", trial.machine)]
    what = "frozen" if how is How.FREEZE else "killed"
    found = [_stamped(hit.at, what, name) for name in hit.processes]
    begun = hit.started.items() if what == "killed" else ()
    return found + [Happening(hit.at, at, hit.back, "started", name) for name, at in begun]


def _stamped(at: float, what: str, who: str, told: str = "") -> Happening:
    return Happening(at - CLOCKS, at, at + CLOCKS, what, who, told)


def keep(folder: Path, trial: Trial, relay: str, found: list[Happening]) -> None:
    """Add a trial to the file of its machine; `relay` is the process behind the leaf that was hit."""
    folder.mkdir(mode=0o700, exist_ok=True)
    told = {"machine": trial.machine, "stop": trial.stop.name, "fault": trial.fault, "relay": relay}
    with (folder / f"{trial.machine}.jsonl").open("a", encoding="utf-8") as file:
        file.write(json.dumps({**told, "happened": [asdict(one) for one in found]}) + "\n")
