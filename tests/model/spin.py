"""Has SPIN explore the model, and reads what it says. A search that is not exhaustive is an error."""

import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

SITE = Path(__file__).with_name("site.pml")
MEMORY = 3900  # MiB that a verifier may use; two of them go on at once
DEPTH = 1_000_000  # steps of the longest history
TABLE = 24  # 2^24 slots of the table of states at first
SIZES = (
    "MACHINES", "GATEWAYS", "RUNS", "TRIES", "GOALS", "FAULTS", "PRESSES", "ARMS_MOST", "CANCELS", "LONG", "SKETCHED",
)  # fmt: skip
INCOMPLETE = ("Search not completed", "max search depth too small", "out of memory", "search incomplete")


class ModelError(Exception):
    """The model could not be explored, or not exhaustively."""


@dataclass(frozen=True)
class Check:
    """One size of the site that is explored."""

    name: str
    what: str
    sizes: tuple[int, ...]  # in the order of SIZES
    cycles: bool = False  # whether to look for histories that never end, too

    def definitions(self, *defects: str) -> list[str]:
        """What the preprocessor of SPIN gets."""
        sizes = [f"-D{name}={value}" for name, value in zip(SIZES, self.sizes, strict=True)]
        return [*sizes, *(f"-D{defect}" for defect in defects)]


@dataclass(frozen=True)
class Found:
    """What a search has found."""

    states: int
    violation: str = ""  # what does not hold; empty: everything holds
    history: tuple[str, ...] = ()  # how it comes to that


def explore(check: Check, folder: Path, seconds: float, *defects: str) -> Found:
    """Explore all states of a check, with defects planted.

    Raises:
        ModelError: it could not, or not exhaustively.
    """
    compile_model(check.definitions(*defects), folder, ["-DNP" if check.cycles else "-DSAFETY"])
    words = ["./pan", f"-m{DEPTH}", f"-w{TABLE}", *(["-l"] if check.cycles else [])]
    text = call(words, folder, seconds)
    found = read(text)
    if not found.violation:
        return found
    return Found(found.states, found.violation, replay(check, folder, *defects))


def compile_model(definitions: list[str], folder: Path, flags: list[str]) -> None:
    """Make the verifier `pan` in a folder."""
    call(["spin", "-a", *definitions, str(SITE)], folder, 60.0)
    limits = [f"-DMEMLIM={MEMORY}", "-DVECTORSZ=4096", "-DNOREDUCE", "-DNOFAIR"]
    call(["gcc", "-O1", "-w", *limits, *flags, "-o", "pan", "pan.c"], folder, 240.0)


def call(words: list[str], folder: Path, seconds: float) -> str:
    """Run a program in a folder; returns what it prints.

    Raises:
        ModelError: it is missing, takes too long, or fails.
    """
    if shutil.which(words[0], path=None) is None and not words[0].startswith("./"):
        raise ModelError(f"{words[0]} is missing: make model installs it")
    try:
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired as error:
        raise ModelError(f"{words[0]} has not ended within {seconds:.0f} s") from error
    if done.returncode != 0:
        raise ModelError(f"{words[0]} ends with code {done.returncode}: {(done.stdout + done.stderr)[-2000:]}")
    return done.stdout + done.stderr


def read(text: str) -> Found:
    """Read what the verifier says.

    Raises:
        ModelError: it has not seen all states.
    """
    states = re.search(r"^\s*([\d.e+]+) states, stored", text, re.MULTILINE)
    errors = re.search(r"errors: (\d+)", text)
    if states is None or errors is None:
        raise ModelError(f"SPIN says something else: {text[-2000:]}")
    count = int(float(states[1]))
    if int(errors[1]):
        what = re.search(r"^pan:1: (.*)$", text, re.MULTILINE)
        return Found(count, what[1] if what is not None else "an error without words")
    for words in INCOMPLETE:
        if words in text:
            raise ModelError(f"not all states were explored: {words}")
    return Found(count)


def replay(check: Check, folder: Path, *defects: str) -> tuple[str, ...]:
    """The history that leads to a violation, in words."""
    trail = next(folder.glob("*.trail"))
    text = call(["spin", "-k", trail.name, "-T", "-B", *check.definitions(*defects), str(SITE)], folder, 60.0)
    return tuple(line.strip() for line in text.splitlines() if line.strip() and not line.startswith("spin: trail"))
