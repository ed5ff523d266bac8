"""The report of `tms import`: what was found, what the check of its trees says, and what comes of it."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tms_cli import session
from tms_cli.reasons import CannotRun
from tms_cli.words import say, sentence, with_command
from tms_reason.errors import DbError
from tms_reason.reason import Reason
from tms_reason.texts import text

if TYPE_CHECKING:
    from tms_db.import_plan import Item, Plan
    from tms_db.store import Db

SHOWN = 3  # warnings of one tree on a terminal; --json has all


def carry_out(db: "Db", path: Path, *, replace: bool, dry_run: bool, skip_refused: bool) -> "tuple[Plan, bool]":
    """Import a folder or an archive; returns the report, and whether it was written.

    Raises:
        TmsError: there is nothing to import, or the store is away; then nothing was written.
    """
    from tms_db import import_plan, import_source, import_write, schema, templates
    from tms_db.task_text import MODELS

    source = import_source.read(path)
    schema.refuse_newer(f"database {db.name}", schema.stored(db))
    plan = import_plan.plan(db, source, {*MODELS, *session.site().models}, replace=replace)

    def stored(name: str) -> str | None:
        try:
            return templates.Templates(db).get(name).task_sequence
        except DbError as error:
            if error.code == "TEMPLATE_MISSING":
                return None
            raise

    judge(plan, stored)
    if dry_run or (plan.count(import_plan.REFUSED) and not skip_refused):
        return plan, False
    schema.bring_up(db)
    import_write.write(db, plan)
    return plan, True


def judge(plan: "Plan", stored: Callable[[str], str | None]) -> None:
    """Check the trees that are to be stored; `stored` gives the text of a template that is in the database."""
    from tms_db.import_plan import NEW, REFUSED
    from tms_ts import bt
    from tms_ts.tree_reasons import Line, Placed

    own = {item.name: item.text for item in plan.items if item.kind == "template" and item.state != REFUSED}

    def known(name: str) -> str | None:
        return own.get(name) or stored(name)

    for item in plan.items:
        if item.state != NEW or item.kind not in ("task", "template"):
            continue
        report: bt.CheckReport | bt.TemplateReport
        if item.kind == "task":
            report = bt.check(item.text, templates=known)
        else:
            report = bt.check_template(item.name, item.text, known)
        item.warnings += [CannotRun(error.reason) for error in report.errors]
        item.warnings += [Placed(Line(line), what) for line, what in report.warnings]


def summary(plan: "Plan") -> dict[str, int]:
    """How many things came out how."""
    from tms_db.import_plan import NEW, OTHER, REFUSED, THERE

    warned = sum(1 for item in plan.items if item.state == NEW and item.warnings)
    return {
        "as_they_are": plan.count(NEW) - warned, "with_warnings": warned, "there": plan.count(THERE),
        "refused": plan.count(REFUSED), "left_out": plan.count(OTHER),
    }  # fmt: skip


def show(plan: "Plan", *, imported: bool, as_json: bool) -> None:
    """Print the report."""
    counts = summary(plan)
    if as_json:
        session.show_json({"imported": imported, "summary": counts, "items": [_as_dict(item) for item in plan.items]})
        return
    for item in plan.items:
        for line in _lines(item):
            click.echo(line)
    line = (
        "{as_they_are} as they are, {with_warnings} with warnings, {there} there already, {refused} refused, "
        "{left_out} left out"
    )
    click.echo(say(line, **counts))


def _lines(item: "Item") -> list[str]:
    from tms_db.import_plan import OTHER, REFUSED, THERE

    if item.why is not None and item.state in (REFUSED, OTHER):
        word = say("refused") if item.state == REFUSED else say("left out")
        return [f"{item.place}: {word}: {with_command(item.why)}"]
    named = {
        "task": say("task {name}", name=item.name), "template": say("template {name}", name=item.name),
        "record": say("record {name}", name=item.name),
    }[item.kind]  # fmt: skip
    found = [f"{item.place}: {named}" + (say(" (there already)") if item.state == THERE else "")]
    found += [f"  {say('warning')}: {sentence(one)}" for one in item.warnings[:SHOWN]]
    if (more := len(item.warnings) - SHOWN) > 0:
        found.append(say("  and {more} more warnings", more=more))
    return found


def _as_dict(item: "Item") -> dict[str, Any]:
    def english(reason: Reason | None) -> str | None:
        return None if reason is None else text(reason, "en")

    return {
        "kind": item.kind, "place": item.place, "name": item.name, "state": item.state, "why": english(item.why),
        "warnings": [english(one) for one in item.warnings],
    }  # fmt: skip
