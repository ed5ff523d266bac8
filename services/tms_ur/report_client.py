"""The daily report as a file: its cycles and grounds are asked of tms:db, and it is made here."""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import date, datetime, timedelta
from typing import Literal

from tms_msg_ground.srv import ReadSnapshot

from tms_machine.asking import ask
from tms_reason.errors import RosError, TmsError
from tms_report import page, sheet
from tms_report.facts import Facts
from tms_report.ground_of_day import Stored, change_in
from tms_ros.node import Ros
from tms_soil import patches
from tms_ur.ground_client import KEPT, KEPT_LIMIT
from tms_ur.reasons import GroundNotRead
from tms_ur.work_client import cycles_of
from tms_work import sums
from tms_work.plan import Plan

Form = Literal["html", "pdf"]
FORMS: dict[Form, Callable[[Facts], bytes]] = {"html": page.render, "pdf": sheet.render}
NONE = "GROUND_NOT_THERE"
LEAST = timedelta(microseconds=1)  # between a time and the next one


@dataclass(frozen=True)
class Wanted:
    """Which report is asked for."""

    site: str
    day: date
    plan: Plan | None
    form: Form
    language: str


def report(ros: Ros, wanted: Wanted) -> bytes:
    """The daily report of a day in the time of this PC.

    Raises:
        TmsError: tms:db is away or refuses; CyclesNotRead or GroundNotRead.
    """
    begin, end = sums.span(wanted.day)
    cycles = tuple(cycles_of(ros, wanted.day))
    change = change_in(lambda which, first, last: _kept(ros, which, first, last), begin, end)
    return FORMS[wanted.form](Facts(wanted.site, wanted.day, cycles, wanted.language, wanted.plan, change))


def _kept(ros: Ros, which: str, begin: datetime | None, end: datetime) -> Stored | None:
    """See `ground_of_day.Kept`."""
    after = "" if begin is None else (begin - LEAST).isoformat()
    request = ReadSnapshot.Request(snapshot=which, after=after, until=(end - LEAST).isoformat())
    try:
        answer = ask(ros, ReadSnapshot, KEPT, request, KEPT_LIMIT)
    except RosError as error:
        if error.code == NONE:
            return None
        raise
    if not answer.taken_at:
        return None
    try:
        return Stored(datetime.fromisoformat(answer.taken_at), patches.heights(answer.ground))
    except ValueError as error:
        raise TmsError(GroundNotRead(answer.taken_at, str(error))) from error
