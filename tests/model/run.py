"""`make model`: the protocol of stop, permit, fence and latch in all its states."""

import json
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from time import perf_counter
from typing import TypeVar

import click

from model.checks import CHECKS, DEFECTS
from model.spin import Check, Found, explore

LIMIT = 900.0  # s for one search
T = TypeVar("T")


def searched(check: Check, *defects: str) -> tuple[Found, float]:
    """Explore in a folder of its own; returns what was found, and the seconds."""
    begun = perf_counter()
    with tempfile.TemporaryDirectory(prefix="tms-model-") as folder:
        found = explore(check, Path(folder), LIMIT, *defects)
    return found, perf_counter() - begun


def both_cores(
    search: Callable[[T], tuple[Found, float]], wanted: Sequence[T]
) -> Iterator[tuple[T, tuple[Found, float]]]:
    """What each search finds, in this order; two of them go on at once."""
    with ThreadPoolExecutor(2) as pool:
        yield from zip(wanted, pool.map(search, wanted), strict=True)


def tell(found: Found) -> None:
    """Print how it comes to a violation."""
    for line in found.history:
        click.echo(f"    {line}")
    click.echo(f"  VIOLATION: {found.violation}")


def check_all(names: tuple[str, ...], as_json: bool) -> int:
    """Explore the checks; returns the number of violations."""
    states, violations, rows = 0, 0, []
    for check, (found, seconds) in both_cores(
        searched, [check for check in CHECKS if not names or check.name in names]
    ):
        states += found.states
        violations += bool(found.violation)
        rows.append({"check": check.name, "states": found.states, "seconds": round(seconds, 1),
                     "violation": found.violation, "history": found.history})  # fmt: skip
        if not as_json:
            click.echo(f"{check.name:12} {found.states:10,} states, {seconds:5.1f} s   {check.what}")
            tell(found) if found.violation else None
    if as_json:
        click.echo(json.dumps({"states": states, "violations": violations, "checks": rows}, indent=2))
    else:
        click.echo(f"{states} states, {violations} violations")
    return violations


def check_defects(names: tuple[str, ...], as_json: bool) -> int:
    """Plant defects one at a time; returns the number of those that are not found."""
    rows = []
    wanted = [name for name in DEFECTS if not names or name in names]
    for name, (found, seconds) in both_cores(lambda name: searched(DEFECTS[name][1], name), wanted):
        rows.append({"defect": name, "found": found.violation, "seconds": round(seconds, 1)})
        if not as_json:
            what = DEFECTS[name][0]
            click.echo(f"{'found' if found.violation else 'SURVIVED':9} {name:26} {seconds:5.1f} s   {what}")
    survived = sum(not row["found"] for row in rows)
    if as_json:
        click.echo(json.dumps({"defects": rows, "survived": survived}, indent=2))
    else:
        click.echo(f"{len(rows)} defects, {survived} survived")
    return survived


@click.command()
@click.option("--defects", is_flag=True, help="Plant each defect of checks.py instead; each must be found.")
@click.option("--only", multiple=True, metavar="NAME", help="This check, or this defect; more than one may be named.")
@click.option("--json", "as_json", is_flag=True, help="One document for programs instead of lines.")
def main(defects: bool, only: tuple[str, ...], as_json: bool) -> None:
    """Explore every state of small sites: stops, permits, fencing numbers, latches, crashes, freezes, people.

    A violation ends with exit code 1 and its history in words. A search that could not see all states is an error.

    \b
    Examples:
      make model                       all checks
      make model ONLY=1x2              one of them
      make model DEFECTS=1             each planted defect must be found
      make model DEFECTS=1 ONLY=LOSS_NOT_SEEN
    """
    known = set(DEFECTS) if defects else {check.name for check in CHECKS}
    unknown = set(only) - known
    if unknown:
        raise click.UsageError(f"unknown: {', '.join(sorted(unknown))}; known: {', '.join(sorted(known))}")
    sys.exit(1 if (check_defects if defects else check_all)(only, as_json) else 0)


if __name__ == "__main__":
    main()
