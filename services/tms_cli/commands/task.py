"""`tms task`: tasks (behaviour trees) in the database."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tms_cli import live, session, templates
from tms_cli.reasons import InTaskFile, TaskUnknown
from tms_cli.task_file import read
from tms_cli.words import Group, say
from tms_reason.errors import TaskError, TmsError

if TYPE_CHECKING:
    from tms_msg_db.msg import Task
    from tms_msg_db.srv import AddTask

    from tms_ros.node import Ros

task_id_argument = click.argument("task_id", type=click.IntRange(1), metavar="ID")


@click.group(cls=Group)
def command() -> None:
    """Store, list, show, check and remove tasks.

    \b
    Examples:
      tms task add configs/tasks/one_loading_cycle.xml
      tms task list
      tms task check my_task.xml
    """


@command.command()
@click.argument("file")
@click.option("--description", default="", help="One line for people.  [default: No Commented.]")
@session.json_option
def add(file: str, description: str, as_json: bool) -> None:
    """Store a task that Groot saved; the database gives it a number.

    The same file twice is reported, not stored twice.

    \b
    Examples:
      tms task add configs/tasks/one_loading_cycle.xml --description "one cycle"
    """
    with session.ros() as node:
        answer = store(node, file, description)
    if as_json:
        session.show_json(
            {"task_id": answer.task_id, "already_stored": answer.already_stored, "model_name": answer.model_name}
        )
    else:
        click.echo(stored_line(answer))


def stored_line(answer: "AddTask.Response") -> str:
    """The result of storing a task, in one line."""
    if answer.already_stored:
        return say("already stored as task {task}", task=answer.task_id)
    return say("stored as task {task}: run it with `tms run {task} --wait`", task=answer.task_id)


def store(node: "Ros", file: str, description: str) -> "AddTask.Response":
    """Store a file as a task; returns the answer of AddTask.

    Raises:
        TmsError: the file is no task, or the database refused it.
    """
    from tms_msg_db.srv import AddTask

    text = read(file)
    try:
        return session.call(node, AddTask, "/tms/db/add_task", task_sequence=text, description=description)
    except TmsError as error:
        if error.code != TaskError.code:
            raise
        raise TaskError(InTaskFile(file, error.reason), TaskError.code) from error


@command.command("list")
@session.json_option
def list_(as_json: bool) -> None:
    """List the stored tasks."""
    from tms_msg_db.srv import ListTasks

    with session.ros() as node:
        tasks = session.call(node, ListTasks, "/tms/db/list_tasks").tasks
    if as_json:
        session.show_json([_as_dict(task) for task in tasks])
        return
    click.echo(f"{'TASK':>5}  {'MODEL':<10} {'STORED':<19}  DESCRIPTION")
    for task in tasks:
        click.echo(f"{task.task_id:>5}  {task.model_name:<10} {live.clock_time(task.added_at):<19}  {task.description}")
    if not tasks:
        click.echo(say("none yet: `tms task add FILE` stores one"), err=True)


@command.command()
@click.argument("what", metavar="WHAT")
@click.option("--ascii", "form", flag_value="ascii", help="The tree as text, one line a node.")
@click.option("--dot", "form", flag_value="dot", help="The tree as a graph for Graphviz.")
@session.json_option
def show(what: str, form: str | None, as_json: bool) -> None:
    """Print a stored task's XML (its number), for example into a file that Groot can open; or its tree as a picture.

    The pictures are drawn by py_trees, also of a file: {-} and {o} are Sequence and Fallback, [-] and [o] their
    reactive kinds, /_/ is Parallel, -^- a decorator or subtree, --> any other node.

    \b
    Examples:
      tms task show 1 > task.xml
      tms task show 1 --ascii
      tms task show configs/tasks/one_loading_cycle.xml --dot > tree.dot
    """
    if form and as_json:
        raise click.UsageError(f"--{form} and --json: choose one")
    task = _task(what)
    if as_json:
        session.show_json({**_as_dict(task), "task_sequence": task.task_sequence})
    elif form:
        click.echo(_picture(task.task_sequence, None if task.task_id else Path(what).parent, form))
    else:
        click.echo(task.task_sequence.rstrip())


def number(what: str) -> int | None:
    """The task number in an argument; None for a file's name.

    Raises:
        TaskError: no task can have that number.
    """
    if not (what.isascii() and what.isdigit()):
        return None
    if not 0 < int(what[:20]) < 2**31:
        raise TaskError(TaskUnknown(what), "NO_TASK")
    return int(what)


def _task(what: str) -> "Task":
    """A stored task, named on stderr, or a file as one without a number.

    Raises:
        TmsError: there is no such task or file.
    """
    from tms_msg_db.msg import Task
    from tms_msg_db.srv import GetTask

    task_id = number(what)
    if task_id is None:
        return Task(description=Path(what).name, task_sequence=read(what))
    with session.ros() as node:
        task = session.call(node, GetTask, "/tms/db/get_task", task_id=task_id).task
    model = task.model_name or say("no model")
    click.echo(say("task {task}, {model}: {text}", task=task.task_id, model=model, text=task.description), err=True)
    return task


def _picture(text: str, folder: Path | None, form: str) -> str:
    """A tree as py_trees draws it.

    Raises:
        TreeError: it cannot be loaded.
    """
    from tms_cli import check_task
    from tms_ts.bt import load
    from tms_ts.bt.display import ascii_tree, dot

    with check_task.SchedulerClient() as mesh:  # which is needed for templates only
        tree = load(text, folder=folder, templates=lambda name: templates.text_of(mesh.node(), name))
    return (dot(tree) if form == "dot" else ascii_tree(tree)).rstrip()


@command.command()
@task_id_argument
@session.json_option
def rm(task_id: int, as_json: bool) -> None:
    """Remove a task; its number becomes free."""
    from tms_msg_db.srv import RemoveTask

    with session.ros() as node:
        session.call(node, RemoveTask, "/tms/db/remove_task", task_id=task_id)
    if as_json:
        session.show_json({"removed": task_id})
    else:
        click.echo(say("task {task} removed", task=task_id))


@command.command()
@click.argument("what", metavar="WHAT")
@click.option("--recursive", is_flag=True, help="Also the folders inside a folder.")
@click.option("--cpp", is_flag=True, help="As the C++ system does: a $key$ without a value becomes the word none.")
@session.json_option
@click.pass_context
def check(ctx: click.Context, what: str, recursive: bool, cpp: bool, as_json: bool) -> None:
    """Check a file, a stored task (its number) or a folder of files, without running; exit code 1 if there are errors.

    Lists every goal that a leaf would send to a machine, errors and warnings with their lines; of a folder one line
    a file. The scheduler also looks for the records and subtasks that a task names, and the templates that it calls
    come from the database. While no mesh runs, and with --cpp, the structure alone is checked.

    \b
    Examples:
      tms task check my_task.xml
      tms task check 1 --json
      tms task check configs/tasks
    """
    from tms_cli import check_report, check_task

    folder = Path(what).is_dir()
    if recursive and not folder:
        raise click.UsageError(f"--recursive is for folders, and {what} is none")
    with check_task.SchedulerClient(cpp=cpp) as scheduler:
        if folder:
            right = check_report.show_folder(
                check_task.folder(scheduler, Path(what), recursive=recursive), as_json=as_json
            )
        elif (task_id := number(what)) is not None:
            right = check_report.show_one(check_task.stored(scheduler, task_id), as_json=as_json)
        else:
            right = check_report.show_one(check_task.file(scheduler, Path(what)), as_json=as_json)
    ctx.exit(0 if right else 1)


def _as_dict(task: "Task") -> dict[str, Any]:
    return {
        "task_id": task.task_id,
        "model_name": task.model_name,
        "description": task.description,
        "added_at": live.iso(task.added_at),
    }
