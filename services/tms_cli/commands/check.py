"""`tms check`: is the site's configuration right?"""

from collections import Counter
from collections.abc import Sequence

import click

from tms_cli import session
from tms_cli.words import say
from tms_core.config import Site, load_site
from tms_core.processes import Process, discovery_server, table
from tms_core.sensing import load_sensing

MANY = 40  # processes on a PC that run at once: with more, a discovery server takes a third off their cost


@click.command()
@click.option("--site", "chosen", metavar="NAME|FILE", help="Site to check (default: the one in use).")
@session.json_option
def command(chosen: str | None, as_json: bool) -> None:
    """Check the configuration; nothing is started.

    \b
    Examples:
      tms check
      tms check --site configs/sites/yard.yaml
    """
    site = load_site(chosen) if chosen else session.site()
    rows = table(site)
    inputs = load_sensing(site).inputs
    if as_json:
        session.show_json(
            {
                "site": site.name, "file": str(site.path), "processes": [row.full for row in rows],
                "inputs": list(inputs), "hints": _hints(site, rows),
            }
        )  # fmt: skip
        return
    click.echo(
        say(
            "{file}: right ({machines} machines, {processes} processes, {inputs} sensing inputs)",
            file=site.path,
            machines=len(site.file.machines),
            processes=len(rows),
            inputs=len(inputs),
        )
    )
    for text in _hints(site, rows):
        click.echo(text)


def _hints(site: Site, rows: Sequence[Process]) -> list[str]:
    """What is right, but would be better otherwise."""
    most = max(Counter(row.pc for row in rows).values(), default=0)
    if discovery_server(site) is not None or most <= MANY:
        return []
    return [
        say(
            "hint: with {count} processes on one PC, `network: {{discovery: server}}` saves processor time "
            "(deploy/README.md, section 8)",
            count=most,
        )
    ]
