"""`make traces`: what observers saw in the trials of a drill is a history of the model.

They see a thing later than it happens, so the order of what comes close together is not known: one order that their
times allow must be a history of the model.
"""

import json
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from model.traces import ENDS, Reader
from tms_cli.drill.history import ARRIVES, FOLDER, Happening
from tms_cli.drill.plan import NONE, RP, STAND_INS, How

KNOWN = (How.CANCEL, How.SOFTWARE, How.KILL, How.FREEZE, How.POWER)  # the model has no simulator that is away
REACH = 8  # places by which a word is moved at most
ATTEMPTS = 60  # orders that are tried for a trial


@dataclass(frozen=True)
class Seen:
    """A word of the model, and between which times it was said."""

    first: float
    last: float
    word: str

    def may_precede(self, others: Sequence["Seen"]) -> bool:
        """Whether it can have been said before all of these."""
        return all(self.first <= other.last for other in others)


def is_known(trial: dict[str, Any]) -> bool:
    """Whether the model has words for a trial: it has no liars, and no planner beside the relay."""
    stop = STAND_INS.stops[trial["stop"]]
    return trial["fault"] == NONE and stop.how in KNOWN and stop.processes != (RP,)


def words_of(trial: dict[str, Any]) -> list[Seen]:
    """The words of a trial in the most likely order."""
    names = {f"{trial['machine']}:rc": "GATEWAY", trial["relay"]: "RELAY", "tms:ts": "SCHEDULER", "tms:host": "HOST"}
    happened = sorted((Happening(**one) for one in trial["happened"]), key=lambda one: one.likely)
    return [seen for one in happened for seen in _of(one, names)]


def _of(one: Happening, names: dict[str, str]) -> Iterator[Seen]:
    process = names.get(one.who)
    if one.what == "accepts":
        yield Seen(one.first - ARRIVES, one.last, "SENDS 1")
    word = {
        "killed": process and f"KILLED_{process} 0", "frozen": process and f"FROZE_{process} 0",
        "started": process and f"STARTED_{process} 0", "pressed": "PRESSED 0", "accepts": "ACCEPTS 1",
        "receipt": f"{one.told.upper()} 0", "run": _of_run(one.told),
    }[one.what]  # fmt: skip
    if word:
        yield Seen(one.first, one.last, word)


def _of_run(state: str) -> str | None:
    state = state.removeprefix("STATE_").lower()
    return "BEGINS 1" if state == "running" else "OVER 1" if state in ENDS else None


def accepted(reader: Reader, seen: list[Seen]) -> tuple[int, list[str]]:
    """How many words of the best order that was found are accepted, and that order."""
    best = seen
    for _ in range(ATTEMPTS):
        if reader.accepts(_texts(best)):
            return len(best), _texts(best)
        read = reader.read(_texts(best))
        better = next((one for one in _moved(best, read) if reader.accepts(_texts(one)[: read + 1])), None)
        if better is None:
            break
        best = better
    return reader.read(_texts(best)), _texts(best)


def _texts(seen: list[Seen]) -> list[str]:
    return [one.word for one in seen]


def _moved(seen: list[Seen], at: int) -> Iterator[list[Seen]]:
    """Other orders in which the word that is refused does not come next."""
    for later in range(at + 1, min(at + REACH, len(seen))):
        if seen[later].may_precede(seen[at:later]):
            yield [*seen[:at], seen[later], *seen[at:later], *seen[later + 1 :]]
    for earlier in range(at - 1, max(-1, at - REACH), -1):
        if not seen[at : at + 1] or not seen[at].may_precede(seen[earlier:at]):
            break
        yield [*seen[:earlier], seen[at], *seen[earlier:at], *seen[at + 1 :]]


def check(trials: Sequence[dict[str, Any]]) -> int:
    """Have the model read the trials; returns how many it refuses."""
    refused = 0
    with tempfile.TemporaryDirectory(prefix="tms-model-") as folder:
        reader = Reader(Path(folder))
        for trial in trials:
            seen = words_of(trial)
            read, order = accepted(reader, seen)
            if read < len(seen):
                refused += 1
                what = f"{trial['machine']}, {trial['stop']}"
                click.echo(f"REFUSED {what}: {' '.join(order[:read])}  >>> {' '.join(order[read:])}")
    return refused


@click.command()
@click.argument("state", type=click.Path(exists=True, file_okay=False, path_type=Path))
def main(state: Path) -> None:
    """Check the trials of the drill whose state is in this folder.

    \b
    Example:
      make drill QUICK=1 && make traces
    """
    trials = [json.loads(line) for path in sorted((state / FOLDER).glob("*.jsonl")) for line in path.open()]
    known = [trial for trial in trials if is_known(trial)]
    if not known:
        raise click.ClickException(f"{state / FOLDER} has no trials that the model knows: run `make drill` first")
    refused = check(known)
    click.echo(f"{len(known)} of {len(trials)} trials are in words of the model, {refused} refused")
    sys.exit(1 if refused else 0)


if __name__ == "__main__":
    main()
