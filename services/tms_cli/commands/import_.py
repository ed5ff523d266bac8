"""`tms import`: tasks, templates and records of the C++ system into the database."""

from pathlib import Path

import click

from tms_cli import importing, session
from tms_cli.open_store import opened
from tms_cli.words import say


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--dry-run", is_flag=True, help="Report only; write nothing.")
@click.option("--replace", is_flag=True, help="Templates and records that are there with another content get this one.")
@click.option("--skip-refused", is_flag=True, help="Import the rest also when something is refused.")
@session.json_option
@click.pass_context
def command(ctx: click.Context, folder: Path, dry_run: bool, replace: bool, skip_refused: bool, as_json: bool) -> None:
    """Take over the tasks, templates and records of the C++ system, version 5 or 6; exit code 1 if nothing is written.

    FOLDER is its configuration (trees as .xml, records as .yaml) or a dump of its database (task, subtask and
    parameter as .bson of mongodump, or as .json); folders in it are read, too. A tree that others call with
    ExecuteSubtask, or that has a $key$, becomes a template, any other a task.

    Everything is compared and checked first, and reported. All of it is written, or nothing: when something is
    refused, and when the store is lost on the way. The same import again changes nothing. Trees that cannot run yet
    are taken, with a warning.

    This talks to the store itself, as `tms db` does; a mesh may stay up.

    \b
    Examples:
      tms import ~/ros2_ws/src/ros2_tms_for_construction/tms_ts/tms_ts_manager/config --dry-run
      tms import dump/rostmsdb
    """
    from tms_db import import_plan, import_source, import_write, schema, templates
    from tms_db.task_text import MODELS
    from tms_reason.errors import DbError

    source = import_source.read_folder(folder)
    with opened() as db:
        schema.refuse_newer(f"database {db.name}", schema.stored(db))
        plan = import_plan.plan(db, source, {*MODELS, *session.site().models}, replace=replace)

        def stored(name: str) -> str | None:
            try:
                return templates.Templates(db).get(name).task_sequence
            except DbError as error:
                if error.code == "TEMPLATE_MISSING":
                    return None
                raise

        importing.judge(plan, stored)
        blocked = plan.count(import_plan.REFUSED) > 0 and not skip_refused
        if not (dry_run or blocked):
            schema.bring_up(db)
            import_write.write(db, plan)
    importing.show(plan, imported=not (dry_run or blocked), as_json=as_json)
    if blocked:
        click.echo(say("nothing was written: correct what is refused, or --skip-refused imports the rest"), err=True)
    elif dry_run:
        click.echo(say("nothing was written: this was a trial"), err=True)
    ctx.exit(1 if blocked else 0)
