"""The work of a day: cycles as the database tells them."""

from datetime import date, datetime, timedelta, timezone
from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_db.srv import ListCycles

from tms_reason.errors import TmsError
from tms_ur.reasons import CyclesNotRead
from tms_ur.work_client import work
from tms_ur.work_models import WorkPlan
from unit.tms_ur.fakes import cycle

DAY = date(2026, 11, 26)


def asked(*cycles: str) -> tuple[Any, list[ListCycles.Request]]:
    """A database with these cycles, and what it is asked for."""
    requests: list[ListCycles.Request] = []

    def call(_: Any, __: str, request: ListCycles.Request, ___: float) -> ListCycles.Response:
        requests.append(request)
        return ListCycles.Response(cycles=list(cycles))

    return SimpleNamespace(call=call), requests


def test_a_day_of_this_pc_is_asked_for_and_summed_up() -> None:
    dug = [cycle(DAY, number, "dig", bank=0.5, parts={"dig": 30.0}).model_dump_json() for number in (0, 1, 6)]
    ros, requests = asked(*dug)
    found = work(ros, DAY, WorkPlan(bank=10.0))
    begin, end = (datetime.fromisoformat(one) for one in (requests[0].begin, requests[0].end))
    assert begin == datetime(2026, 11, 26).astimezone() and end - begin == timedelta(days=1)
    assert (found.total.cycles, found.total.bank, found.total.rate) == (3, 1.5, pytest.approx(60.0))
    assert [(one.name, one.cycles) for one in found.machines] == [("zx200", 3)]
    nine = datetime(2026, 11, 26, 9, tzinfo=timezone.utc).astimezone().hour
    assert [(int(one.name), one.cycles) for one in found.hours] == [(nine, 2), (nine + 1, 1)]
    assert found.plan is not None and found.plan.bank == 10.0


def test_a_cycle_that_cannot_be_read_is_told() -> None:
    ros, _ = asked('{"run_id": "r"}')
    with pytest.raises(TmsError) as caught:
        work(ros, DAY, None)
    assert isinstance(caught.value.reason, CyclesNotRead)
