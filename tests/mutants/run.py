"""`make mutants`: plants defects one at a time, and sees that the simulation finds each of them."""

import json
import os
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict
from datetime import date
from pathlib import Path

import click

from mutants.catalogue import DoesNotApply, Mutant, mutants
from mutants.hunt import violation
from mutants.ledger import Ledger
from mutants.plant import HuntFailed, Verdict, look_for

SEED = 1  # the same for all, so that the schedules are the same each time


def chosen(every: Sequence[Mutant], only: Sequence[str], count: int | None, turn: int) -> list[Mutant]:
    """Those with these names, or by turns the next `count`."""
    unknown = sorted(set(only) - {one.name for one in every})
    if unknown:
        raise click.UsageError(f"no mutant is called {', '.join(unknown)}; all names: make mutants LIST=1")
    if only:
        return [one for one in every if one.name in only]
    if count is None or count >= len(every):
        return list(every)
    return [every[(turn * count + i) % len(every)] for i in range(count)]


def verdicts(some: Sequence[Mutant], seed: int, schedules: int, workers: int, ledger: Ledger) -> Iterator[Verdict]:
    """The verdict of each, as soon as it is known; those of the ledger first."""
    known = {one.name: ledger.known(one) for one in some}
    yield from (verdict for verdict in known.values() if verdict is not None)
    with ThreadPoolExecutor(workers) as pool:
        todo = {pool.submit(look_for, one, seed, schedules): one for one in some if known[one.name] is None}
        for future in as_completed(todo):
            verdict = future.result()
            check_seed(todo[future], verdict)
            ledger.keep(todo[future], verdict)
            yield verdict


def check_seed(mutant: Mutant, verdict: Verdict) -> None:
    """The code itself must violate nothing with the seed that has found a mutant."""
    if verdict.seed is not None and (found := violation(mutant.package, verdict.seed)):
        raise click.ClickException(f"without any defect, seed {verdict.seed} violates: {found}")


def told(verdict: Verdict, wrong: str) -> str:
    """One line for people."""
    if verdict.survived:
        return f"{verdict.name}: SURVIVED {verdict.tried} schedules: {wrong}"
    return f"{verdict.name}: found after {verdict.tried} schedules (seed {verdict.seed}: {verdict.violation})"


@click.command()
@click.option("--schedules", "-n", default=5_000, show_default=True, help="How many are tried for each mutant.")
@click.option("--seed", "-s", default=SEED, show_default=True, help="First seed of each.")
@click.option("--only", "-o", multiple=True, help="A mutant by its name; may be given again.")
@click.option("--slice", "count", type=click.IntRange(1), help="By turns, so many of them.")
@click.option("--turn", default=lambda: date.today().toordinal(), show_default="each day the next", type=int)
@click.option("--workers", default=os.cpu_count() or 1, show_default=True, help="Mutants side by side.")
@click.option("--ledger", type=click.Path(path_type=Path), help="File of what is done: the same command continues.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object a line.")
@click.option("--list", "listed", is_flag=True, help="Names of all mutants, and what goes wrong.")
def main(schedules: int, seed: int, only: tuple[str, ...], count: int | None, turn: int, workers: int,
         ledger: Path | None, as_json: bool, listed: bool) -> None:  # fmt: skip
    """Plant defects in the decisions and proofs, one at a time; the simulation must find each.

    Each mutant runs in a fresh interpreter on a copy of its package; the tree stays as it is. The schedules are the
    same for all, and the same each time. Exit code 1 if a mutant has survived.

    \b
    Examples:
      make mutants                              all of them, 5,000 schedules each
      make mutants SLICE=20                     the 20 of this day
      make mutants ONLY=a-latch-is-not-closed   one
      make mutants LEDGER=/tmp/mutants          can be interrupted and continued
      make mutants LIST=1                       their names
    """
    every = mutants()
    wrong = {one.name: one.wrong for one in every}
    if listed:
        click.echo("\n".join(f"{name}: {what}" for name, what in wrong.items()))
        return
    some, survived = chosen(every, only, count, turn), 0
    if not as_json:
        click.echo(f"{len(some)} of {len(every)} mutants, {schedules} schedules from seed {seed} on, {workers} workers")
    try:
        for verdict in verdicts(some, seed, schedules, workers, Ledger(ledger, seed, schedules)):
            survived += verdict.survived
            click.echo(json.dumps(asdict(verdict)) if as_json else told(verdict, wrong[verdict.name]))
    except (DoesNotApply, HuntFailed) as problem:
        raise click.ClickException(str(problem)) from problem
    summary = {"mutants": len(some), "survived": survived}
    click.echo(json.dumps(summary) if as_json else f"{len(some)} mutants, {survived} survived")
    sys.exit(1 if survived else 0)


if __name__ == "__main__":
    main()
