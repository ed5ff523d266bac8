"""The work of a day: asked of tms:db as cycles, summed up here."""

from datetime import date

from pydantic import ValidationError
from tms_msg_db.srv import ListCycles

from tms_machine.asking import ask
from tms_reason import validation
from tms_reason.errors import TmsError
from tms_ros.node import Ros
from tms_ur.reasons import CyclesNotRead
from tms_ur.work_models import Work, sum_of
from tms_work import sums
from tms_work.cycle import Cycle
from tms_work.plan import Plan

SERVICE, LIMIT = "/tms/db/list_cycles", 15.0  # s for an answer: a day has thousands of cycles


def cycles_of(ros: Ros, day: date) -> list[Cycle]:
    """The cycles of a day, in the time of this PC.

    Raises:
        TmsError: tms:db is away or refuses, or CyclesNotRead.
    """
    begin, end = sums.span(day)
    request = ListCycles.Request(begin=begin.isoformat(), end=end.isoformat())
    try:
        return [Cycle.model_validate_json(one) for one in ask(ros, ListCycles, SERVICE, request, LIMIT).cycles]
    except ValidationError as error:
        raise TmsError(CyclesNotRead(validation.explain(error))) from error


def work(ros: Ros, day: date, plan: Plan | None) -> Work:
    """What was moved on a day, in the time of this PC.

    Raises:
        TmsError: see `cycles_of`.
    """
    cycles = cycles_of(ros, day)
    of_hour = sums.hour(None)
    return Work(
        day=day, plan=plan, total=sum_of("", sums.total(cycles)),
        machines=[sum_of(name, one) for name, one in sums.by(cycles, lambda one: one.machine).items()],
        hours=[sum_of(name.split()[1], one) for name, one in sums.by(cycles, of_hour).items()],
    )  # fmt: skip
