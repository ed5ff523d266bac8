"""`make simulate`: thousands of schedules of a site in virtual time, side by side."""

import os
import random
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

import click

from ledger import Lines
from simulation.plan import PEOPLE, SECONDS
from simulation.schedule import Result, Schedule, shorter

BATCH = 50  # schedules that a worker does at a time
SHOWN = 3  # violations that are made shorter and told in words
RESERVE = 10**12  # a schedule in which no goal leaves is replaced by the one with this much more


@dataclass
class Done:
    """What some schedules were like."""

    count: int = 0
    goals: Counter[int] = field(default_factory=Counter)  # goals that left for a machine -> schedules
    faults: Counter[int] = field(default_factory=Counter)
    hundreds: Counter[int] = field(default_factory=Counter)  # hundreds of events
    acts: Counter[str] = field(default_factory=Counter)  # what went wrong
    bad: list[int] = field(default_factory=list)  # seeds with a violation

    def add(self, result: Result) -> None:
        self.count += 1
        self.goals[result.goals] += 1
        self.faults[len(result.plan) - PEOPLE] += 1
        self.hundreds[result.events // 100] += 1
        self.acts.update(type(one.act).__name__ for one in result.plan)
        if result.violation:
            self.bad.append(result.seed)

    def join(self, other: "Done") -> None:
        self.count += other.count
        for name in ("goals", "faults", "hundreds", "acts"):
            getattr(self, name).update(getattr(other, name))
        self.bad += other.bad


def moving(seed: int) -> Result:
    """A schedule with this seed in which a goal moves a machine, or one that violates an invariant."""
    result = Schedule(seed).run()
    while not result.goals and not result.violation:
        seed += RESERVE
        result = Schedule(seed).run()
    return result


def batch(first: int, count: int) -> tuple[int, Done, float]:
    """Schedules with their seeds from `first` on, and how long they had the processor [s]."""
    done, begun = Done(), process_time()
    for seed in range(first, first + count):
        done.add(moving(seed))
    return first, done, process_time() - begun


class Ledger:
    """The batches that are done, in a file, so that a long series can be continued."""

    def __init__(self, path: Path | None) -> None:
        self._lines = Lines(path)
        self.known: dict[int, Done] = {first: _done(values) for first, values in self._lines.read}

    def keep(self, first: int, done: Done) -> None:
        """Add a batch."""
        self._lines.keep(first, vars(done))


def _done(values: dict[str, Any]) -> Done:
    numbers = {
        name: Counter({int(key): n for key, n in values[name].items()}) for name in ("goals", "faults", "hundreds")
    }
    return Done(values["count"], acts=Counter(values["acts"]), bad=values["bad"], **numbers)


def batches(seed: int, schedules: int, known: dict[int, Done]) -> Iterator[tuple[int, int]]:
    """First seed and number of each batch that is not done yet."""
    for first in range(seed, seed + schedules, BATCH):
        if first not in known:
            yield first, min(BATCH, seed + schedules - first)


def tell(seed: int) -> None:
    """A violation in words, with the shortest plan found."""
    short = shorter(Schedule(seed).run())
    click.echo(f"\nseed {short.seed}: {short.violation}\nwhat goes wrong:")
    for planned in short.plan:
        click.echo(f"  {planned}")
    click.echo("history:")
    for line in short.history:
        click.echo(f"  {line}")


def spread(counts: Counter[int], unit: int = 1) -> str:
    """Least, median and most."""
    values = sorted(counts.elements())
    return f"{values[0] * unit} to {values[-1] * unit}, median {values[len(values) // 2] * unit}"


@click.command()
@click.option("--schedules", "-n", default=15_000, show_default=True, help="How many.")
@click.option("--seed", "-s", default=None, type=int, help="First seed; a random one if it is not given.")
@click.option("--workers", default=os.cpu_count() or 1, show_default=True, help="Processes side by side.")
@click.option("--ledger", type=click.Path(path_type=Path), help="File of what is done: the same command continues.")
def main(schedules: int, seed: int | None, workers: int, ledger: Path | None) -> None:
    """Let a site go wrong in virtual time, and look at its invariants at every moment.

    The same seed gives the same history. A violation ends with exit code 1, its seed, the shortest plan that violates,
    and the history in words.

    \b
    Examples:
      make simulate                          15,000 schedules
      make simulate SCHEDULES=200 SEED=7     the same 200 each time
      make simulate SCHEDULES=1 SEED=1234    one, as a violation has told it
      make simulate SCHEDULES=1000000 SEED=1 LEDGER=/tmp/million    can be interrupted and continued
    """
    if ledger is not None and seed is None:
        raise click.UsageError("a series that is continued needs a seed")
    first = random.SystemRandom().randrange(1_000_000_000) if seed is None else seed
    click.echo(f"{schedules} schedules of {SECONDS:.0f} s from seed {first} on, {workers} side by side")
    kept, done, begun = Ledger(ledger), Done(), perf_counter()
    for one in kept.known.values():
        done.join(one)
    before, busy = done.count, 0.0
    with ProcessPoolExecutor(workers) as pool:
        todo = list(batches(first, schedules, kept.known))
        for number, one, seconds in pool.map(batch, *zip(*todo, strict=True)) if todo else ():
            kept.keep(number, one)
            done.join(one)
            busy += seconds
            if done.count % 1000 == 0 or done.count == schedules:
                count = done.count - before
                speed = f"{count / (perf_counter() - begun):.0f} a second ({count / busy:.0f} on a core of its own)"
                click.echo(f"{done.count:7} done, {speed}, {len(done.bad)} violations")
    _report(done)
    sys.exit(1 if done.bad else 0)


def _report(done: Done) -> None:
    for seed in done.bad[:SHOWN]:
        tell(seed)
    if len(done.bad) > SHOWN:
        click.echo(f"\nmore seeds with violations: {', '.join(map(str, done.bad[SHOWN:]))}")
    click.echo(f"goals that left for a machine: {spread(done.goals)}; events: {spread(done.hundreds, 100)}")
    click.echo(f"faults: {spread(done.faults)}: {', '.join(f'{name} {n}' for name, n in done.acts.most_common())}")
    click.echo(f"{done.count} schedules, {len(done.bad)} violations")


if __name__ == "__main__":
    main()
