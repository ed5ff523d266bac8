"""`tms logs`: the last lines of a process's log."""

import subprocess

import click

from tms_cli import session
from tms_cli.reasons import NoLog
from tms_config.processes import find, table
from tms_reason.errors import TmsError


@click.command()
@click.argument("process", required=False)
@click.option("-n", "--lines", default=40, show_default=True, type=click.IntRange(1, 10000))
@click.option("-f", "--follow", is_flag=True, help="Go on showing new lines until Ctrl-C.")
def command(process: str | None, lines: int, follow: bool) -> None:
    """Show the log of one process, or of all of them.

    \b
    Examples:
      tms logs tms:ts
      tms logs rc --follow
    """
    site = session.site()
    rows = [find(site, process)] if process else list(table(site))
    files = [site.state / "log" / f"{row.group}.{row.name}.log" for row in rows]
    there = [str(file) for file in files if file.exists()]
    if not there:
        raise TmsError(NoLog(str(site.state / "log")))
    subprocess.run(["tail", "-n", str(lines), *(["-F"] if follow else []), "--", *there], check=False)
