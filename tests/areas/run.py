"""Machines between areas in virtual time; last line: `N area histories, M crossings, P % needless stops (planned)`."""

import math
import os
import sys
from concurrent.futures import ProcessPoolExecutor

import click

from areas import people
from areas.history import Result, run
from areas.shared import run as sharing

NEEDLESS = (
    2.0  # percent at most of planned drives that end with a stop that nothing asked for; whims of wild drivers are none
)
WALKS = 10  # histories of machines for each history of people, which takes ten times as long


def judged(seed: int) -> Result:
    """A history, and whether the machine would have crossed a border without the law."""
    found = run(seed)
    if found.stopped is not None:
        found.would_cross = any(run(seed, False, at).crossed is not None for at in (math.inf, found.stopped))
    return found


def shared(histories: int, seed: int, pool: ProcessPoolExecutor) -> bool:
    """Histories of machines that share places, a tenth as many; whether all is well."""
    done = list(pool.map(sharing, range(seed, seed + max(1, histories // 10)), chunksize=5))
    wrong = [one for one in done if one.two_inside or one.unseen or one.starved]
    for one in wrong[:10]:
        click.echo(f"seed {one.seed}: {one}")
    sums = {name: sum(getattr(one, name) for one in done) for name in ("rounds", "circles", "stops", "held", "revoked")}
    click.echo(f"{len(done)} histories of shared places, {len(wrong)} wrong: {sums}")
    return not wrong


@click.command()
@click.option("--histories", "-n", default=10_000, show_default=True)
@click.option("--seed", "-s", default=0, show_default=True)
@click.option("--workers", default=os.cpu_count() or 1)
def main(histories: int, seed: int, workers: int) -> None:
    """Drive machines between areas in virtual time."""
    with ProcessPoolExecutor(workers) as pool:
        fine = shared(histories, seed, pool)
        done = list(pool.map(judged, range(seed, seed + histories), chunksize=20))
        walks = list(pool.map(people.run, range(seed, seed + max(1, histories // WALKS)), chunksize=5))
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
    sys.exit(1 if crossed or late or share > NEEDLESS or not fine else 0)


if __name__ == "__main__":
    main()
