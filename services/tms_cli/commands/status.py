"""`tms status`: show whether the mesh runs, and every fault."""

import click

from tms_cli import session, words
from tms_cli.words import say
from tms_config.processes import table
from tms_host.supervisor import Supervisor
from tms_reason.reason import Foreign
from tms_reason.texts import text
from tms_runtime import metrics


@click.command()
@session.json_option
@click.pass_context
def command(ctx: click.Context, as_json: bool) -> None:
    """Say in one look whether everything works; exit code 1 if not.

    \b
    Example:
      tms status
    """
    site = session.site()
    states = {row.name: row.state for row in Supervisor(site).processes()}
    shown = ("RUNNING", "FATAL")
    rows = [row for row in table(site) if (row.full in states and row.autostart) or states.get(row.full) in shown]
    reasons = {
        row.full: metrics.unready(row)
        if states.get(row.full) == "RUNNING"
        else Foreign(states.get(row.full, "UNKNOWN"))
        for row in rows
        if row.ours
    }
    bad = {name: reason for name, reason in reasons.items() if reason is not None}
    if as_json:
        session.show_json(
            {
                "site": site.name,
                "ready": not bad,
                "processes": {name: why and text(why, "en") for name, why in reasons.items()},
            }
        )
    else:
        for name, reason in reasons.items():
            click.echo(f"{name:42} {say('ready') if reason is None else words.with_command(reason)}")
    ctx.exit(1 if bad else 0)
