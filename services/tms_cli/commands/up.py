"""`tms up`: start the mesh of this PC and wait until its processes are ready."""

import os

import click

from tms_cli import mesh, session
from tms_cli.reasons import NoPcs
from tms_cli.words import say
from tms_config.config import Site
from tms_config.processes import here
from tms_reason.errors import ConfigError
from tms_ur import address


@click.command()
@click.option("--role", metavar="PC", help="Which PC of the site this is: a key under pcs: of the site file.")
@click.option("--foreground", is_flag=True, help="Become supervisord instead: for containers and systemd.")
@click.option("--no-wait", is_flag=True, help="Return as soon as supervisord runs.")
def command(role: str | None, foreground: bool, no_wait: bool) -> None:
    """Start the mesh of this PC; harmless when it already runs.

    \b
    Examples:
      tms up
      tms --site yard up --role cps
      tms --site yard up --role cps --foreground
    """
    if role is not None:
        os.environ["TMS_PC"] = role
    site = session.site()
    if role is not None and not site.file.pcs:
        raise ConfigError(NoPcs(str(site.path)))
    started = mesh.up(site, foreground)
    click.echo(mesh_line(site, started), err=True)
    if not no_wait:
        mesh.wait_ready(site, lambda text: click.echo(text, err=True))
        console = any(row.name == "ur" for row in here(site))
        click.echo(say("ready: {url}", url=address.url(site.file)) if console else say("ready"), err=True)


def mesh_line(site: Site, started: bool) -> str:
    """A line about the mesh that runs now."""
    name = f"'{site.name}'" + (say(" on PC '{pc}'", pc=site.pc) if site.pc else "")
    if started:
        return say("mesh {name} started, state in {folder}", name=name, folder=site.state)
    return say("mesh {name} already runs, state in {folder}", name=name, folder=site.state)
