"""`tms import`: tasks, templates and records of the C++ system into the database."""

from pathlib import Path

import click

from tms_cli import importing, session
from tms_cli.open_store import opened
from tms_cli.words import say


@click.command()
@click.argument("path", type=click.Path(path_type=Path), metavar="FROM")
@click.option("--dry-run", is_flag=True, help="Report only; write nothing.")
@click.option("--replace", is_flag=True, help="Templates and records that are there with another content get this one.")
@click.option("--skip-refused", is_flag=True, help="Import the rest also when something is refused.")
@session.json_option
@click.pass_context
def command(ctx: click.Context, path: Path, dry_run: bool, replace: bool, skip_refused: bool, as_json: bool) -> None:
    """Take over tasks, templates and records of the C++ system, version 5 or 6; exit code 1 if something is refused.

    FROM is a folder, read with the folders in it: its configuration (trees as .xml, records as .yaml) or a dump of its
    database (task, subtask and parameter as .bson of mongodump, or as .json); or it is an archive of mongodump. A tree
    that others call with ExecuteSubtask, or that has a $key$, becomes a template, any other a task.

    Everything is compared and checked first, and reported. All of it is written, or nothing: when something is
    refused, and when the store is lost on the way. The same import again changes nothing. Trees that cannot run yet
    are taken, with a warning.

    This talks to the store itself, as `tms db` does; a mesh may stay up.

    \b
    Examples:
      tms import ~/ros2_ws/src/ros2_tms_for_construction/tms_ts/tms_ts_manager/config --dry-run
      tms import dump/rostmsdb
    """
    with opened() as db:
        plan, imported = importing.carry_out(db, path, replace=replace, dry_run=dry_run, skip_refused=skip_refused)
    importing.show(plan, imported=imported, as_json=as_json)
    if imported:
        return
    if dry_run:
        click.echo(say("nothing was written: this was a trial"), err=True)
    else:
        click.echo(say("nothing was written: correct what is refused, or --skip-refused imports the rest"), err=True)
    ctx.exit(1 if importing.summary(plan)["refused"] and not skip_refused else 0)
