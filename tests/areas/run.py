"""Machines between areas in virtual time; last line: `N area histories, M crossings, P % needless stops (planned)`."""

import math
import os
import random
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from typing import TypeVar

import click

from areas import people
from areas.history import Result, run
from areas.shared import run as sharing

NEEDLESS = 2.0  # percent at most of planned drives that end with a stop that nothing asked for; wild ones plan nothing
JUDGED = 1000  # planned drives from which on that share is judged; of 68 three are 4.4 %, by chance one time in six
T = TypeVar("T")
WALKS = 10  # histories of machines for each history of people


def judged(seed: int) -> Result:
    """A history, and whether the machine would have crossed a border without the law."""
    found = run(seed)
    if found.stopped is not None:
        found.would_cross = any(run(seed, False, at).crossed is not None for at in (math.inf, found.stopped))
    return found


def each(pool: ProcessPoolExecutor, run: Callable[[int], T], seeds: range, what: str) -> list[T]:
    """What the histories of some seeds have shown; how far they are is told."""
    with click.progressbar(pool.map(run, seeds, chunksize=5), len(seeds), what, file=sys.stderr) as done:
        return list(done)


def shared(histories: int, seed: int, pool: ProcessPoolExecutor) -> bool:
    """Histories of machines that share places, a tenth as many; whether all is well."""
    done = each(pool, sharing, range(seed, seed + max(1, histories // 10)), "shared places")
    wrong = [one for one in done if one.two_inside or one.unseen or one.starved]
    for one in wrong[:10]:
        click.echo(f"seed {one.seed}: {one}")
    sums = {name: sum(getattr(one, name) for one in done) for name in ("rounds", "circles", "stops", "held", "revoked")}
    click.echo(f"{len(done)} histories of shared places, {len(wrong)} wrong: {sums}")
    return not wrong


@click.command()
@click.option("--histories", "-n", default=10_000, show_default=True)
@click.option("--seed", "-s", default=None, type=int, help="First seed; a random one if it is not given.")
@click.option("--workers", default=os.cpu_count() or 1, show_default=True, help="Processes side by side.")
def main(histories: int, seed: int | None, workers: int) -> None:
    """Drive machines between areas in virtual time."""
    if seed is None:
        seed = random.SystemRandom().randrange(1_000_000_000)
    click.echo(f"areas: seeds from {seed} on")
    with ProcessPoolExecutor(workers) as pool:
        fine = shared(histories, seed, pool)
        done = each(pool, judged, range(seed, seed + histories), "areas")
        walks = each(pool, people.run, range(seed, seed + max(1, histories // WALKS)), "people")
    late = [one for one in walks if one.moved]
    for walk in late[:10]:
        click.echo(f"seed {walk.seed}: a machine moved among people at {walk.moved}")
    click.echo(
        f"{len(walks)} histories of people, {sum(one.entered for one in walks)} entries, "
        f"{sum(one.stops for one in walks)} stops, {len(late)} too late"
    )
    crossed = [one for one in done if one.violation]
    planned = [one for one in done if not one.wild]
    needless = [one for one in planned if one.stopped is not None and not one.would_cross]
    for one in crossed[:10]:
        click.echo(f"seed {one.seed}: {one.violation}, {one}")
    for name, some in (("planned", planned), ("wild", [one for one in done if one.wild])):
        stops = [one for one in some if one.stopped is not None]
        click.echo(
            f"{name}: {len(some)}, {sum(one.reached for one in some)} goals reached, "
            f"{sum(one.held > 0 for one in some)} held, {sum(one.refused for one in some)} refused, "
            f"{len(stops)} stopped, {sum(not one.would_cross for one in stops)} needless"
        )
    share = 100.0 * len(needless) / max(1, len(planned))
    click.echo(f"{len(done)} area histories, {len(crossed)} crossings, {share:.1f} % needless stops (planned)")
    often = len(planned) >= JUDGED and share > NEEDLESS
    sys.exit(1 if crossed or late or often or not fine else 0)


if __name__ == "__main__":
    main()
