"""`tms abandon`: give up an interrupted run."""

import click

from tms_cli import session
from tms_cli.commands.runs import interrupted
from tms_cli.words import say


@click.command()
@click.argument("run")
@session.json_option
def command(run: str, as_json: bool) -> None:
    """Give up an interrupted run for good; it cannot be resumed afterwards.

    RUN is its id, the beginning of it, or `last` for the newest interrupted run.

    \b
    Example:
      tms abandon 20260131-060000-1a2b
    """
    from tms_msg_ts.srv import CancelRun

    with session.ros() as node:
        run = interrupted(node, run)
        session.of_any(node, session.site(), CancelRun, "abandon_run", "NO_RUN", run_id=run)
    if as_json:
        session.show_json({"run_id": run, "state": "abandoned"})
    else:
        click.echo(say("run {run} is abandoned", run=run))
