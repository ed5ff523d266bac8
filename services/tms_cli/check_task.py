"""The checks of `tms task check`: structure here, records and subtasks by the scheduler of a running mesh."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click
from tms_msg_db.srv import GetTask, GetTemplate
from tms_msg_ts.srv import CheckTask

from tms_cli import session, templates
from tms_cli.task_file import read, xml_files
from tms_cli.words import reason, say, sentence, with_command
from tms_config.clock import monotonic
from tms_reason.errors import RosError, TaskError, TmsError
from tms_schedulers.asking import of_first
from tms_ts import bt
from tms_ts.bt.source import parse
from tms_ts.tree_reasons import Line, Placed

if TYPE_CHECKING:
    from tms_ros.node import Ros

R = TypeVar("R")
PROGRESS = 2.0  # s between two lines about the progress of a folder


@dataclass
class CheckedTask:
    """One file or stored task; errors and warnings are lines that begin with their place."""

    what: str
    nodes: int = 0
    goals: list[bt.LeafGoal] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    no_task: str = ""  # why it is no task
    by: str = "structure"  # what has checked it: structure, scheduler, or cpp: the structure as the C++ system sees it

    def as_dict(self) -> dict[str, Any]:
        return {
            "ok": not self.errors and not self.no_task,
            "errors": self.errors,
            "warnings": self.warnings,
            "nodes": self.nodes,
            "goals": [asdict(goal) for goal in self.goals],
            "checked_by": self.by,
        }

    def verdict(self) -> str:
        """One line for the list of a folder."""
        if self.no_task:
            return say("no task: {why}", why=self.no_task)
        counts = []
        if self.errors:
            counts.append(say("1 error") if len(self.errors) == 1 else say("{count} errors", count=len(self.errors)))
        if self.warnings:
            counts.append(
                say("1 warning") if len(self.warnings) == 1 else say("{count} warnings", count=len(self.warnings))
            )
        first = f": {' '.join(self.errors[0].split())}" if self.errors else ""
        return (", ".join(counts) or say("ok")) + first


@dataclass
class CheckedTemplate:
    """One template; errors and warnings are lines that begin with their place."""

    what: str
    keys: list[str]
    errors: list[str]
    warnings: list[str]


class SchedulerClient(AbstractContextManager["SchedulerClient"]):
    """Scheduler and database of the mesh; one that does not answer is not called a second time.

    cpp: checks are for the C++ system, and the scheduler is not asked
    """

    def __init__(self, *, cpp: bool = False) -> None:
        self.cpp = cpp
        self._open = ExitStack()
        self._node: Ros | None = None
        self._absent = self._no_database = False

    def __exit__(self, *_: object) -> None:
        self._open.close()

    def node(self) -> "Ros":
        if self._node is None:
            self._node = self._open.enter_context(session.ros())
        return self._node

    def ask_scheduler(self, found: CheckedTask, **task: Any) -> None:
        """Have the scheduler check a task whose structure has no errors."""
        if self.cpp:
            found.by = "cpp"
        if self.cpp or self._absent or found.errors:
            return
        try:
            node, where = self.node(), session.site()
            answer = of_first(where, lambda one: session.call(node, CheckTask, one.named("check_task"), **task))
        except RosError:
            self._absent = True
            return
        except TmsError as error:
            if error.code != TaskError.code:
                raise
            found.errors = [str(error)]
        else:
            found.errors = list(map(reason, answer.errors))
            found.warnings = list(map(reason, answer.warnings))
        found.by = "scheduler"

    def with_templates(self, check: Callable[[bt.Templates | None], R]) -> R:
        """Do a check with the templates of the database; with None for them where no database answers."""
        if not self._no_database:
            try:
                return check(lambda name: templates.text_of(self.node(), name))
            except RosError:
                self._no_database = True
        return check(None)


def structure(client: SchedulerClient, what: str, text: str, folder: Path | None = None) -> CheckedTask:
    """Check the structure of a tree, without a site."""
    report = client.with_templates(lambda known: bt.check(text, folder=folder, templates=known, cpp=client.cpp))
    warnings = [with_command(Placed(Line(line), warning)) for line, warning in report.warnings]
    if report.ok and "<include" in text:
        warnings += [
            f"it cannot be stored as a task: {sentence(error.reason)}"
            for error in bt.check(text, templates=None).errors
        ]
    return CheckedTask(
        what, report.nodes, report.goals, [with_command(error.reason) for error in report.errors], warnings
    )


def stored(scheduler: SchedulerClient, task_id: int) -> CheckedTask:
    """Have the scheduler check a stored task, and find its lines."""
    task = session.call(scheduler.node(), GetTask, "/tms/db/get_task", task_id=task_id).task
    found = structure(scheduler, str(task_id), task.task_sequence)
    scheduler.ask_scheduler(found, task_id=task_id)
    return found


def file(scheduler: SchedulerClient, path: Path) -> CheckedTask:
    """Check one file.

    Raises:
        TaskError: it cannot be read.
    """
    text = read(str(path))
    why = no_task(text)
    found = CheckedTask(str(path), errors=[f"this is no task: {why}"], no_task=why) if why else None
    found = found or structure(scheduler, str(path), text, path.parent)
    scheduler.ask_scheduler(found, xml=text)
    return found


def template(client: SchedulerClient, what: str) -> CheckedTemplate:
    """Check a template: a file, or a stored one by its name.

    Raises:
        TmsError: the file cannot be read, or there is no template of this name.
    """
    path = Path(what)
    is_file = path.exists() or path.suffix.lower() == ".xml"
    name, text = (path.stem, read(what)) if is_file else (what, _stored_template(client, what))
    report = client.with_templates(lambda known: bt.check_template(name, text, known, cpp=client.cpp))
    warnings = [with_command(Placed(Line(line), warning)) for line, warning in report.warnings]
    return CheckedTemplate(what, report.keys, [with_command(error.reason) for error in report.errors], warnings)


def _stored_template(client: SchedulerClient, name: str) -> str:
    return session.call(client.node(), GetTemplate, "/tms/db/get_template", template_name=name).stored.task_sequence


def no_task(text: str) -> str:
    """Why a well-formed document is no task; empty if it is one, or is broken."""
    try:
        root = parse(text).root
    except bt.TreeError:
        return ""
    if root.tag != "root":
        return f"its outermost element is <{root.tag}>, not <root>"
    if root.find("BehaviorTree") is not None or root.find("include") is not None:
        return ""
    palette = root.find("TreeNodesModel") is not None
    return "it has a TreeNodesModel only (a palette for Groot)" if palette else "there is no <BehaviorTree> in it"


def folder(scheduler: SchedulerClient, path: Path, *, recursive: bool) -> Iterator[CheckedTask]:
    """Check the XML files of a folder, in the order of their names.

    Raises:
        TaskError: there are none.
    """
    files = xml_files(path, recursive=recursive)
    reported = monotonic()
    for count, name in enumerate(files):
        if monotonic() - reported >= PROGRESS:
            reported = monotonic()
            click.echo(say("{count} of {files} files checked", count=count, files=len(files)), err=True)
        try:
            found = file(scheduler, name)
        except TaskError as error:
            found = CheckedTask(str(name), errors=[str(error).removeprefix(f"{name}: ")])
        found.what = str(name.relative_to(path))
        if found.no_task:
            found.errors = []
        yield found
