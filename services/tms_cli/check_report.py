"""Shows the findings of `tms task check`."""

from collections.abc import Iterable

import click

from tms_cli import session
from tms_cli.check_task import CheckedTask, CheckedTemplate
from tms_cli.words import say


def show_one(found: CheckedTask, *, as_json: bool) -> bool:
    """Show the findings about one task; returns whether it has no errors."""
    if as_json:
        session.show_json(found.as_dict())
    else:
        for line in goal_table(found):
            click.echo(line)
        for word, lines in ((say("error"), found.errors), (say("warning"), found.warnings)):
            for line in lines:
                click.echo(f"{found.what}: {word}: {line}")
        if not found.errors:
            right = say("can run") if found.by == "scheduler" else say("its structure is right")
            click.echo(f"{found.what}: {right}")
    report_unchecked([found])
    return not found.errors


def goal_table(found: CheckedTask) -> list[str]:
    """The goals of a task as a table, in document order."""
    rows = [(str(goal.line), goal.machine, goal.subtask, goal.record, goal.path) for goal in found.goals]
    rows = [("LINE", "MACHINE", "SUBTASK", "RECORD", "NODE"), *rows] if rows else []
    widths = [max(len(cell) for cell in column) for column in zip(*rows, strict=True)]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def show_template(found: CheckedTemplate, *, as_json: bool) -> bool:
    """Show the findings about a template; returns whether it has no errors."""
    if as_json:
        session.show_json({
            "ok": not found.errors, "keys": found.keys, "errors": found.errors, "warnings": found.warnings,
        })  # fmt: skip
        return not found.errors
    if found.keys:
        click.echo(say("keys: {keys}", keys=", ".join(found.keys)))
    for word, lines in ((say("error"), found.errors), (say("warning"), found.warnings)):
        for line in lines:
            click.echo(f"{found.what}: {word}: {line}")
    if not found.errors:
        click.echo(f"{found.what}: {say('its structure is right')}")
    return not found.errors


def show_folder(files: Iterable[CheckedTask], *, as_json: bool) -> bool:
    """Show the files of a folder, each as soon as it is checked; returns whether none has errors."""
    done = []
    for found in files:
        done.append(found)
        if not as_json:
            click.echo(f"{found.what}: {found.verdict()}")
    wrong, none = sum(bool(found.errors) for found in done), sum(bool(found.no_task) for found in done)
    warned = sum(bool(found.warnings and not found.errors) for found in done)
    counts = {"files": len(done), "ok": len(done) - wrong - none - warned, "warnings": warned, "errors": wrong}
    if as_json:
        files_ = [{"file": found.what, "no_task": found.no_task, **found.as_dict()} for found in done]
        session.show_json({"ok": not wrong, "files": files_, "summary": {**counts, "no_task": none}})
    report_unchecked(done)
    if not as_json:
        line = "{files} files: {ok} ok, {warnings} with warnings, {errors} with errors, {none} no task"
        click.echo(say(line, **counts, none=none))
    return not wrong


def report_unchecked(done: list[CheckedTask]) -> None:
    """Print on stderr that no scheduler has checked these files."""
    if any(found.by == "structure" and not found.errors and not found.no_task for found in done):
        click.echo(say("no scheduler answers: records and subtasks are unchecked"), err=True)
    elif any(found.by == "structure" and found.errors and not found.no_task for found in done):
        click.echo(say("records and subtasks are unchecked where the structure is wrong"), err=True)
