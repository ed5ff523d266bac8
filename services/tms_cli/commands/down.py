"""`tms down`: end the mesh of this PC."""

import click

from tms_cli import mesh, session


@click.command()
def command() -> None:
    """Stop every process of the mesh on this PC and supervisord itself.

    \b
    Example:
      tms down
    """
    site = session.site()
    ended = mesh.down(site)
    click.echo(f"mesh '{site.name}' {'ended' if ended else 'does not run'}", err=True)
