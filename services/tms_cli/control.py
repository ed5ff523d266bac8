"""start, restart and stop-process: one command with three names."""

import click

from tms_cli import mesh, session
from tms_cli.words import say
from tms_config.processes import find
from tms_host.supervisor import Supervisor


def control_command(what: str, text: str) -> click.Command:
    """A click command that does `what` (start, stop, restart) to a process and waits for the effect."""

    @click.command(help=text)
    @click.argument("process")
    def command(process: str) -> None:
        site = session.site()
        name = find(site, process).full
        Supervisor(site).control(what, name)
        if what != "stop":
            mesh.wait_running(site, name)
        click.echo(say("{name}: stopped", name=name) if what == "stop" else say("{name}: running", name=name), err=True)

    return command
