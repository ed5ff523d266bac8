"""`tms ps`: the processes of this PC."""

from dataclasses import asdict

import click

from tms_cli import session
from tms_cli.words import say
from tms_config.config import Site
from tms_config.processes import Process, table
from tms_host.supervisor import Running, Supervisor

COLOURS = {"RUNNING": "green", "STARTING": "yellow", "BACKOFF": "red", "FATAL": "red", "EXITED": "red"}


@click.command()
@session.json_option
def command(as_json: bool) -> None:
    """List processes: state, pid, uptime, metrics port, purpose.

    Subtasks are started when a task names them, so STOPPED is their normal state before.

    \b
    Examples:
      tms ps
      tms ps --json
    """
    site = session.site()
    rows = {row.full: row for row in table(site)}
    found = Supervisor(site).processes()
    if as_json:
        ports = {name: row.port for name, row in rows.items()}
        session.show_json([{**asdict(process), "port": ports.get(process.name)} for process in found])
        return
    click.echo(f"{'PROCESS':42} {'STATE':9} {'PID':>7} {'UP':>8} {'PORT':>6}  PURPOSE")
    for process in found:
        row = rows.get(process.name)
        state = click.style(f"{process.state:9}", fg=COLOURS.get(process.state))
        port, purpose = (str(row.port), _purpose(site, row)) if row else ("", say("not in the site file any more"))
        click.echo(f"{process.name:42} {state} {process.pid or '':>7} {_up(process):>8} {port:>6}  {purpose}")


def _purpose(site: Site, row: Process) -> str:
    file = site.model_of(row.machine).subtask(row.action).run if row.machine and row.action else ""
    return say(row.purpose, machine=row.machine, file=file)


def _up(process: Running) -> str:
    minutes, seconds = divmod(int(process.uptime), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{seconds:02}" if process.state == "RUNNING" else ""
