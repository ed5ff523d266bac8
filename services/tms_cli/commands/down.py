"""`tms down`: end the mesh of this PC."""

import click

from tms_cli import mesh, session
from tms_cli.words import say


@click.command()
def command() -> None:
    """Stop every process of the mesh on this PC and supervisord itself.

    What systemd or Docker started they bring back: end that with `systemctl stop tms@cps` (its PC after the @), or with
    `make down` and the words of its `make up`.

    \b
    Example:
      tms down
    """
    site = session.site()
    ended = mesh.down(site)
    line = say("mesh '{site}' ended", site=site.name) if ended else say("mesh '{site}' does not run", site=site.name)
    click.echo(line, err=True)
