"""`make simulate`: thousands of schedules of a site in virtual time, side by side."""

import os
import random
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from time import perf_counter

import click

from simulation.plan import SECONDS
from simulation.schedule import Result, Schedule, shorter

BATCH = 50  # schedules that a worker does at a time
SHOWN = 3  # violations that are made shorter and told in words


def batch(first: int, count: int) -> tuple[int, int, int, list[Result]]:
    """Schedules with their seeds from `first` on: their number, events and goals, and those with a violation."""
    events = goals = 0
    bad = []
    for seed in range(first, first + count):
        result = Schedule(seed).run()
        events, goals = events + result.events, goals + result.goals
        if result.violation:
            bad.append(result)
    return count, events, goals, bad


def batches(seed: int, schedules: int) -> Iterator[tuple[int, int]]:
    """First seed and number of each batch."""
    for first in range(0, schedules, BATCH):
        yield seed + first, min(BATCH, schedules - first)


def tell(result: Result) -> None:
    """A violation in words, with the shortest plan found."""
    short = shorter(result)
    click.echo(f"\nseed {short.seed}: {short.violation}\nwhat goes wrong:")
    for planned in short.plan:
        click.echo(f"  {planned}")
    click.echo("history:")
    for line in short.history:
        click.echo(f"  {line}")


@click.command()
@click.option("--schedules", "-n", default=15_000, show_default=True, help="How many.")
@click.option("--seed", "-s", default=None, type=int, help="First seed; a random one if it is not given.")
@click.option("--workers", default=os.cpu_count() or 1, show_default=True, help="Processes side by side.")
def main(schedules: int, seed: int | None, workers: int) -> None:
    """Let a site go wrong in virtual time, and look at its invariants at every moment.

    The same seed gives the same history. A violation ends with exit code 1, its seed, the shortest plan that violates,
    and the history in words.

    \b
    Examples:
      make simulate                          15,000 schedules
      make simulate SCHEDULES=200 SEED=7     the same 200 each time
      make simulate SCHEDULES=1 SEED=1234    one, as a violation has told it
    """
    first = random.SystemRandom().randrange(1_000_000_000) if seed is None else seed
    click.echo(f"{schedules} schedules of {SECONDS:.0f} s from seed {first} on, {workers} side by side")
    done = events = goals = 0
    bad: list[Result] = []
    begun = perf_counter()
    with ProcessPoolExecutor(workers) as pool:
        for count, some, sent, wrong in pool.map(batch, *zip(*batches(first, schedules), strict=True)):
            done, events, goals = done + count, events + some, goals + sent
            bad += wrong
            if done % 1000 == 0 or done == schedules:
                click.echo(f"{done:7} done, {done / (perf_counter() - begun):.0f} a second, {len(bad)} violations")
    for result in bad[:SHOWN]:
        tell(result)
    click.echo(f"{events / done:.0f} events and {goals / done:.1f} goals a schedule on average")
    click.echo(f"{done} schedules, {len(bad)} violations")
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
