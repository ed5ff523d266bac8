"""`tms palette`: print the nodes of trees for Groot."""

from pathlib import Path

import click

from tms_cli import session
from tms_cli.reasons import NotWritable
from tms_reason.errors import TmsError


@click.command()
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="Write it to a file.")
@session.json_option
def command(output: Path | None, as_json: bool) -> None:
    """Print the palette for Groot (TreeNodesModel XML) of every node of this system.

    In Groot: Load palette from file, on the left of the editor.

    \b
    Examples:
      tms palette > tms_palette.xml
      tms palette -o tms_palette.xml
    """
    from tms_ts.bt import palette

    text = palette()
    if output is not None:
        write(output, text)
    if as_json:
        session.show_json({"palette": text, "file": str(output) if output else None})
    elif output is None:
        click.echo(text.rstrip())
    else:
        click.echo(f"{output}: {text.count(' ID=')} nodes; in Groot: Load palette from file", err=True)


def write(file: Path, text: str) -> None:
    """Write the palette; an error names why the file cannot be written."""
    try:
        file.write_text(text, encoding="utf-8")
    except OSError as error:
        raise TmsError(NotWritable(str(file), str(error.strerror))) from error
