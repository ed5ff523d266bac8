"""`tms db`: backup, restore and content of the database."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tms_cli import session
from tms_cli.open_store import opened
from tms_cli.words import Group, say
from tms_config.clock import monotonic

if TYPE_CHECKING:
    from tms_db.backup import Contents

SPEAK = 1.0  # s between progress messages of long work
FILE = click.Path(path_type=Path)


@click.group(cls=Group)
def command() -> None:
    """Back up the database, restore it, see what it holds.

    These talk to the store itself: run them on the PC of tms:db, or wherever TMS_MONGODB_URI is known. The files are
    archives of MongoDB's own tools (mongodump --archive, mongorestore --archive).

    \b
    Examples:
      tms db info
      tms db backup /backup/site-2026-01-31.archive
      tms db restore /backup/site-2026-01-31.archive --drop --yes
    """


@command.command()
@session.json_option
def info(as_json: bool) -> None:
    """Show the store's address (no password), the schema's version and the number of documents.

    \b
    Example:
      tms db info --json
    """
    from tms_db import backup, schema, store, store_address

    with opened() as db:
        contents = backup.describe(db)
    address = store.redact(store_address.uri(session.site()))
    if as_json:
        session.show_json({**_as_dict(contents), "address": address, "newest_schema": schema.NEWEST})
        return
    text = "{name} on {address}, schema {schema} (this program knows {newest})"
    click.echo(say(text, name=contents.database, address=address, schema=contents.schema, newest=schema.NEWEST))
    for name, number in sorted(contents.documents.items()):
        click.echo(f"  {name:<22} {number:>9}")


@command.command()
@click.argument("file", type=FILE)
@click.option("--overwrite", is_flag=True, help="Replace a file that is there.")
@session.json_option
def backup(file: Path, overwrite: bool, as_json: bool) -> None:
    """Write everything in the database into FILE, for this user's eyes only; work may go on meanwhile.

    \b
    Examples:
      tms db backup /backup/site-2026-01-31.archive
      mongorestore --archive=/backup/site-2026-01-31.archive --drop    (what MongoDB's own tool does with it)
    """
    from tms_db import backup

    with opened() as db:
        contents = backup.backup(db, file, _progress(), overwrite=overwrite)
    if as_json:
        session.show_json({**_as_dict(contents), "file": str(file), "bytes": file.stat().st_size})
    else:
        click.echo(f"{file}: {file.stat().st_size / 2**20:.1f} MB, {contents.text}")


@command.command()
@click.argument("file", type=FILE)
@click.option("--drop", is_flag=True, help="Replace everything that the database holds now.")
@click.option("--yes", is_flag=True, help="With --drop: do not ask.")
@session.json_option
def restore(file: Path, drop: bool, yes: bool, as_json: bool) -> None:
    """Put an archive into the database, its documents unchanged; also one of the C++ system's `rostmsdb`.

    FILE comes from `tms db backup` or `mongodump --db rostmsdb --archive=FILE` (with or without --gzip). It is read
    and checked before anything is written. A database that is not empty is refused without --drop, and so is one
    where a run is active. A mesh may stay up; its processes see the restored data after some seconds.

    \b
    Examples:
      tms db restore /backup/site-2026-01-31.archive
      tms db restore rostmsdb.archive --drop --yes
    """
    from tms_db import backup

    if yes and not drop:
        raise click.UsageError("--yes goes with --drop")
    with opened() as db:
        there = backup.describe(db)
        if drop and not yes and any(there.documents.values()):
            question = say("Replace all of database {name} ({there})?", name=db.name, there=there.text)
            click.confirm(question, abort=True, err=True)
        contents = backup.restore(db, file, _progress(), drop=drop)
        into = db.name
    if as_json:
        session.show_json({**_as_dict(contents), "file": str(file), "into": into})
    else:
        click.echo(say("restored into {name}: {report}", name=into, report=contents.text))


def _as_dict(contents: "Contents") -> dict[str, Any]:
    return {"database": contents.database, "schema": contents.schema, "documents": contents.documents}


def _progress() -> Callable[[str], None]:
    """Make a function that prints the progress of long work on stderr, and nothing for short work."""
    last = monotonic()

    def speak(text: str) -> None:
        nonlocal last
        if monotonic() - last >= SPEAK:
            last = monotonic()
            click.echo(text, err=True)

    return speak
