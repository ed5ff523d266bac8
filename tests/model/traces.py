"""Histories of the simulation as words of the model, and whether the model accepts them."""

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from model.spin import SITE, Check, call, compile_model
from simulation import plan as p
from simulation.plan import Planned
from simulation.world import Happened

SIZES = (1, 1, 20, 12, 1, 255, 255, 255, 255, 0, 1)  # nothing is bounded but the runs, and the goals of a run
READER = Check("history", "one machine, whatever happens", SIZES)
KNOWN = (p.Kill, p.Freeze, p.Press, p.Rearm, p.Cancel, p.Trapped)  # the model has no liars, strangers, second runs
OWNER = re.compile(r"is asked for goal (\d+) of Owner\(run=(\d+)")
NUMBER = re.compile(r"(?:sends|accepts) goal (\d+)")
PROCESSES = {"rc": "GATEWAY", "swing": "RELAY", "ts": "SCHEDULER", "host": "HOST"}
ENDS = ("success", "failure", "cancelled", "stop_unconfirmed")


@cache
def numbers() -> dict[str, int]:
    """The words by name, as the model has them."""
    text = SITE.with_name("words.pml").read_text(encoding="utf-8")
    return {name: int(number) for name, number in re.findall(r"^#define ([A-Z_]+) (\d+)", text, re.MULTILINE)}


@dataclass
class Mapping:
    """Turns lines of a history into words; the model numbers runs from 1, in the order in which they begin."""

    words: list[str] = field(default_factory=list)
    _begun: int = 0  # runs so far; one that is resumed counts as another: it has a new fencing number
    _runs: dict[str, int] = field(default_factory=dict)  # by name
    _fences: dict[str, int] = field(default_factory=dict)  # by fencing number
    _goals: dict[str, int] = field(default_factory=dict)  # by number, their runs
    _sender: str = ""  # the run that has sent a goal last

    def take(self, line: Happened) -> None:
        """Add what a line says, if the model knows it."""
        process = PROCESSES.get(line.who.split(":")[-1])
        rules: Sequence[tuple[str, Callable[[], str]]] = (
            (r"is killed", lambda: f"KILLED_{process} 0"),
            (r"is frozen", lambda: f"FROZE_{process} 0"),
            (r"starts \((?!1\))", lambda: f"STARTED_{process} 0"),
            (r"presses stop", lambda: "PRESSED 0"),
            (r"logs armed", lambda: "ARMS 0"),
            (r"tells: confirmed=True", lambda: "CONFIRMED 0"),
            (r"tells: confirmed=False", lambda: "UNCONFIRMED 0"),
            (r"hands a press on", lambda: "HANDED_ON 0"),
            (r"sends goal", lambda: f"SENDS {self._goal(line.what)}"),
            (r"accepts goal", lambda: f"ACCEPTS {self._goal(line.what)}"),
            (r"\S+ is running", lambda: f"BEGINS {self._begins(line.what)}"),
            (rf"\S+ is ({'|'.join(ENDS)})$", lambda: f"OVER {self._runs[line.what.split()[0]]}"),
        )
        if re.match(r"run-\S+ sends ", line.what):
            self._sender = line.what.split()[0]
        asked = OWNER.match(line.what)
        if asked is not None:
            self._goals[asked[1]] = self._fences.setdefault(asked[2], self._runs[self._sender])
        self.words += [word() for pattern, word in rules if re.match(pattern, line.what)]

    def _goal(self, what: str) -> int:
        found = NUMBER.match(what)
        assert found is not None, what
        return self._goals[found[1]]

    def _begins(self, what: str) -> int:
        self._begun += 1
        self._runs[what.split()[0]] = self._begun
        return self._begun


def words_of(history: Iterable[Happened]) -> list[str]:
    """The words of a history of one machine: each a name and, where it has one, the number of a run."""
    mapping = Mapping()
    for line in history:
        mapping.take(line)
    return mapping.words


def known(plan: Iterable[Planned]) -> list[Planned]:
    """The part of a plan that the model has words for."""
    return [one for one in plan if isinstance(one.act, KNOWN)]


class Reader:
    """The model as a reader of histories, compiled once."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        compile_model([*READER.definitions(), "-DHISTORY"], folder, ["-DSAFETY", f"-I{SITE.parent}"])

    def accepts(self, words: Sequence[str]) -> bool:
        """Whether the model can do what the words say, in their order."""
        lines = [f"{numbers()[name] * 1024 + int(what)}\n" for name, what in map(str.split, words)]
        (self._folder / "history").write_text("".join(lines), encoding="utf-8")
        text = call(["./pan", "-m100000", "-w20"], self._folder, 60.0)
        return "assertion violated 0" in text

    def read(self, words: Sequence[str]) -> int:
        """How many of the first words it accepts at most; for people who look for the reason of a refusal."""
        low, high = 0, len(words)
        while low < high:
            middle = (low + high + 1) // 2
            low, high = (middle, high) if self.accepts(words[:middle]) else (low, middle - 1)
        return low
