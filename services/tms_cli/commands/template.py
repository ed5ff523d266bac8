"""`tms template`: trees that tasks call by name (ExecuteSubtask), in the database."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tms_cli import live, session
from tms_cli.reasons import InTaskFile
from tms_cli.task_file import read, xml_files
from tms_cli.words import Group, say
from tms_reason.errors import TaskError, TmsError

if TYPE_CHECKING:
    from tms_msg_db.msg import Template
    from tms_msg_db.srv import AddTemplate

    from tms_ros.node import Ros

name_argument = click.argument("name", metavar="NAME")


@click.group(cls=Group)
def command() -> None:
    """Store, list, show, check and remove templates: trees that tasks call by name with ExecuteSubtask.

    Groot draws a template like a task; a $key$ in an attribute gets its value from the call. A run keeps the
    templates that it began with, also when it is resumed.

    \b
    Examples:
      tms template add configs/templates
      tms template list
      tms template check my_template.xml
    """


@command.command()
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option("--description", default="", help="One line for people.")
@click.option("--replace", is_flag=True, help="Take the place of a template of this name that has another text.")
@session.json_option
def add(files: tuple[str, ...], description: str, replace: bool, as_json: bool) -> None:
    """Store files that Groot saved as templates, or all .xml files of a folder; the file's name is the template's.

    The same text again is reported and no error; another text under a name that is there is refused without
    --replace.

    \b
    Examples:
      tms template add configs/templates/Cruise_Subtask_1_nav.xml
      tms template add configs/templates
      tms template add Dig.xml --replace
    """
    done = []
    with session.ros() as node:
        for file in [path for given in files for path in (xml_files(given) if Path(given).is_dir() else [Path(given)])]:
            answer = store(node, file, description, replace)
            done.append({
                "name": file.stem, "already_stored": answer.already_stored, "replaced": answer.replaced,
                "model_name": answer.model_name,
            })  # fmt: skip
            if not as_json:
                click.echo(stored_line(file.stem, answer))
    if as_json:
        session.show_json(done)


def stored_line(name: str, answer: "AddTemplate.Response") -> str:
    """The result of storing a template, in one line."""
    if answer.already_stored:
        return say("template {name} is stored already", name=name)
    return say("template {name} replaced", name=name) if answer.replaced else say("template {name} stored", name=name)


def store(node: "Ros", file: Path, description: str = "", replace: bool = False) -> "AddTemplate.Response":
    """Store a file as a template under its name.

    Raises:
        TmsError: the file is no template, or the database refused it.
    """
    from tms_msg_db.srv import AddTemplate

    text = read(str(file))
    try:
        return session.call(
            node, AddTemplate, "/tms/db/add_template", template_name=file.stem, task_sequence=text,
            description=description, replace=replace,
        )  # fmt: skip
    except TmsError as error:
        if error.code != TaskError.code:
            raise
        raise TaskError(InTaskFile(str(file), error.reason), TaskError.code) from error


@command.command("list")
@session.json_option
def list_(as_json: bool) -> None:
    """List the stored templates."""
    from tms_msg_db.srv import ListTemplates

    with session.ros() as node:
        templates = session.call(node, ListTemplates, "/tms/db/list_templates").templates
    if as_json:
        session.show_json([_as_dict(one) for one in templates])
        return
    width = max([len(one.template_name) for one in templates], default=8)
    click.echo(f"{'TEMPLATE':<{width}}  {'MODEL':<10} {'STORED':<19}  DESCRIPTION")
    for one in templates:
        click.echo(
            f"{one.template_name:<{width}}  {one.model_name:<10} {live.clock_time(one.added_at):<19}  {one.description}"
        )
    if not templates:
        click.echo(say("none yet: `tms template add FILE` stores one"), err=True)


@command.command()
@name_argument
@session.json_option
def show(name: str, as_json: bool) -> None:
    """Print a template's XML, for example into a file that Groot can open.

    \b
    Example:
      tms template show Dig > Dig.xml
    """
    from tms_msg_db.srv import GetTemplate

    with session.ros() as node:
        found = session.call(node, GetTemplate, "/tms/db/get_template", template_name=name).stored
    if as_json:
        session.show_json({**_as_dict(found), "task_sequence": found.task_sequence})
    else:
        click.echo(found.task_sequence.rstrip())


@command.command()
@name_argument
@session.json_option
def rm(name: str, as_json: bool) -> None:
    """Remove a template; tasks that call it can no longer begin."""
    from tms_msg_db.srv import RemoveTemplate

    with session.ros() as node:
        session.call(node, RemoveTemplate, "/tms/db/remove_template", template_name=name)
    if as_json:
        session.show_json({"removed": name})
    else:
        click.echo(say("template {name} removed", name=name))


@command.command()
@click.argument("what", metavar="WHAT")
@click.option("--cpp", is_flag=True, help="As the C++ system does: a $key$ without a value becomes the word none.")
@session.json_option
@click.pass_context
def check(ctx: click.Context, what: str, cpp: bool, as_json: bool) -> None:
    """Check a file, or a stored template (its name), by itself; exit code 1 if there are errors.

    Tells the keys that a call gives values to, and errors and warnings with their lines: nodes, ports, and the
    templates that it calls. What a task makes of it, `tms task check` tells.

    \b
    Examples:
      tms template check my_template.xml
      tms template check Dig --json
    """
    from tms_cli import check_report, check_task

    with check_task.SchedulerClient(cpp=cpp) as client:
        found = check_task.template(client, what)
    ctx.exit(0 if check_report.show_template(found, as_json=as_json) else 1)


def _as_dict(one: "Template") -> dict[str, Any]:
    return {
        "name": one.template_name, "model_name": one.model_name, "description": one.description,
        "added_at": live.iso(one.added_at),
    }  # fmt: skip
