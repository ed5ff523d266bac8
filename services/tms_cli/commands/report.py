"""`tms report`: the daily report of the site as HTML or PDF."""

from datetime import date, datetime
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tms_cli import new_file, session, words
from tms_cli.days import Day
from tms_cli.open_store import opened
from tms_cli.words import say

if TYPE_CHECKING:
    from tms_db.store import Db
    from tms_report.facts import Facts
    from tms_report.ground_of_day import Stored

KINDS = (".html", ".pdf")


@click.command()
@click.option("--day", type=Day(), required=True, help="A date, today or yesterday.")
@click.option(
    "--output", type=click.Path(path_type=Path), help="File to write, .html or .pdf; default: the day's name."
)
@click.option("--language", type=click.Choice(["en", "ja"]), help="Of the report; default: that of the locale.")
@click.option("--overwrite", is_flag=True, help="Replace a file that is there already.")
@session.json_option
def command(day: date, output: Path | None, language: str | None, overwrite: bool, as_json: bool) -> None:
    """Write the daily report: plan against actual, by machine and hour, plots, and the change of the ground.

    It talks to the store itself: run it on the PC of tms:db, or wherever TMS_MONGODB_URI is known. The plan is
    ground.plan of the site file.

    \b
    Examples:
      tms report --day today
      tms report --day 2026-11-26 --language ja --output report.pdf
    """
    from tms_report import page, sheet

    file = output or Path(f"daily-report-{day.isoformat()}.html")
    if file.suffix.lower() not in KINDS:
        raise click.UsageError(say("the file's name must end with .html or .pdf"))
    with opened() as db:
        facts = _facts(db, day, language or words.language())
    data = (page if file.suffix.lower() == ".html" else sheet).render(facts)
    new_file.write(file, data, overwrite)
    if as_json:
        from tms_cli.commands.work import as_dict

        session.show_json({"file": str(file), "day": day.isoformat(), "total": as_dict(facts.total)})
    else:
        line = "{file}: {cycles} cycles, {bank:.1f} m³ bank, {loads} truck loads"
        total = facts.total
        click.echo(say(line, file=file, cycles=total.cycles, bank=total.bank, loads=total.loads))


def _facts(db: "Db", day: date, language: str) -> "Facts":
    from tms_db.cycles import Cycles
    from tms_ground.settings import ground_of
    from tms_report.facts import Facts
    from tms_report.ground_of_day import change_in
    from tms_work import sums

    site = session.site()
    begin, end = sums.span(day)
    ground = ground_of(site)
    cycles = tuple(Cycles(db).find(begin=begin, end=end))
    return Facts(site.name, day, cycles, language, ground.plan if ground else None, change_in(_Kept(db), begin, end))


class _Kept:
    """The grounds of a store, read by one list of them."""

    def __init__(self, db: "Db") -> None:
        from tms_db.ground import GroundSnapshots

        self._grounds = GroundSnapshots(db)
        self._all = self._grounds.all()

    def __call__(self, which: str, begin: datetime | None, end: datetime) -> "Stored | None":
        from tms_db.ground import chosen
        from tms_report.ground_of_day import Stored

        found = [one for one in self._all if (begin is None or one.taken_at >= begin) and one.taken_at < end]
        if not found:
            return None
        one = chosen(found, which)
        return Stored(one.taken_at, self._grounds.read(one))
