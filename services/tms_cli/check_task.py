"""The checks of `tms task check`: structure here, records and subtasks by the scheduler of a running mesh."""

from collections.abc import Iterator
from contextlib import AbstractContextManager, ExitStack
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from tms_msg_db.srv import GetTask
from tms_msg_ts.srv import CheckTask

from tms_cli import session
from tms_cli.reasons import NoXmlFiles, NoXmlHere
from tms_cli.task_file import read
from tms_cli.words import reason, say, sentence
from tms_config.clock import monotonic
from tms_reason.errors import RosError, TaskError, TmsError
from tms_ts import bt
from tms_ts.bt.reasons import Line, Placed
from tms_ts.bt.source import parse

if TYPE_CHECKING:
    from tms_ros.node import Ros

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
    by: str = "structure"  # what has checked it: structure or scheduler

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


class SchedulerClient(AbstractContextManager["SchedulerClient"]):
    """The scheduler of the mesh; when it does not answer, it is not called a second time."""

    def __init__(self) -> None:
        self._open = ExitStack()
        self._node: Ros | None = None
        self._absent = False

    def __exit__(self, *_: object) -> None:
        self._open.close()

    def node(self) -> "Ros":
        if self._node is None:
            self._node = self._open.enter_context(session.ros())
        return self._node

    def ask_scheduler(self, found: CheckedTask, **task: Any) -> None:
        """Have the scheduler check a task whose structure has no errors."""
        if self._absent or found.errors:
            return
        try:
            answer = session.call(self.node(), CheckTask, "/tms/check_task", **task)
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


def structure(what: str, text: str, folder: Path | None = None) -> CheckedTask:
    """Check the structure of a tree, without a site."""
    report = bt.check(text, folder=folder)
    warnings = [sentence(Placed(Line(line), warning)) for line, warning in report.warnings]
    if report.ok and "<include" in text:
        warnings += [f"it cannot be stored as a task: {sentence(error.reason)}" for error in bt.check(text).errors]
    return CheckedTask(what, report.nodes, report.goals, [sentence(error.reason) for error in report.errors], warnings)


def stored(scheduler: SchedulerClient, task_id: int) -> CheckedTask:
    """Have the scheduler check a stored task, and find its lines."""
    task = session.call(scheduler.node(), GetTask, "/tms/db/get_task", task_id=task_id).task
    found = structure(str(task_id), task.task_sequence)
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
    found = found or structure(str(path), text, path.parent)
    scheduler.ask_scheduler(found, xml=text)
    return found


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
    names = path.rglob("*") if recursive else path.iterdir()
    files = sorted(name for name in names if name.suffix.lower() == ".xml" and not name.is_dir())
    if not files:
        raise TaskError(NoXmlFiles(str(path)) if recursive else NoXmlHere(str(path)), TaskError.code)
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
