"""The work of a day: cycles as the database tells them."""

from datetime import date, datetime, timedelta, timezone
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tms_msg_db.srv import ListCycles
from tms_msg_ground.srv import ReadSnapshot

from tms_reason.errors import TmsError
from tms_soil import patches
from tms_soil.surface import Heights
from tms_ur.reasons import CyclesNotRead, GroundNotRead
from tms_ur.report_client import Wanted, report
from tms_ur.work_client import work
from tms_work.plan import Plan
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
    found = work(ros, DAY, Plan(bank=10.0))
    begin, end = (datetime.fromisoformat(one) for one in (requests[0].begin, requests[0].end))
    assert begin == datetime(2026, 11, 26).astimezone() and end - begin == timedelta(days=1)
    assert (found.total.cycles, found.total.bank, found.total.rate) == (3, 1.5, pytest.approx(60.0))
    assert [(one.name, one.cycles) for one in found.machines] == [("zx200", 3)]
    nine = datetime(2026, 11, 26, 9, tzinfo=timezone.utc).astimezone().hour
    assert [(int(one.name), one.cycles) for one in found.hours] == [(nine, 2), (nine + 1, 1)]
    assert found.plan is not None and found.plan.bank == 10.0


GROUNDS = [datetime(2026, 11, day, hour).astimezone() for day, hour in ((25, 17), (26, 9), (26, 17), (27, 9))]


def store_of(times: list[datetime], heights: int = 1) -> Any:
    """A database without cycles, with flat grounds of these times, each 0.1 m lower than the one before it."""

    def call(_: Any, __: str, request: Any, ___: float) -> Any:
        if isinstance(request, ListCycles.Request):
            return ListCycles.Response()
        after, until = (datetime.fromisoformat(one) if one else None for one in (request.after, request.until))
        found = [one for one in times if (after is None or one > after) and (until is None or one <= until)]
        if not found:
            return ReadSnapshot.Response(error_code="GROUND_NOT_THERE")
        one = found[0 if request.snapshot == "first" else -1]
        z = np.full((10, 10), -0.1 * times.index(one))
        ground = patches.patch(Heights(0.0, 0.0, 1.0, z))
        ground.rows = 10 * heights
        return ReadSnapshot.Response(taken_at=one.isoformat(), ground=ground)

    return SimpleNamespace(call=call)


def report_of(ros: Any) -> str:
    return report(ros, Wanted("yard", DAY, None, "html", "en")).decode()


def test_the_report_has_the_change_of_the_ground_in_the_day() -> None:
    """From the last ground before it, or its first one, to its last one."""
    text = report_of(store_of(GROUNDS))
    assert "From 2026-11-25 17:00 to 2026-11-26 17:00." in text and "<th>Cut</th><td>20.0</td>" in text
    text = report_of(store_of(GROUNDS[1:]))
    assert "From 2026-11-26 09:00 to 2026-11-26 17:00." in text and "<th>Cut</th><td>10.0</td>" in text
    for few in ([], GROUNDS[:1], GROUNDS[1:2], GROUNDS[3:]):
        assert "Cut" not in report_of(store_of(few))


def test_a_ground_of_the_report_that_cannot_be_read_is_told() -> None:
    with pytest.raises(TmsError) as caught:
        report_of(store_of(GROUNDS, heights=2))
    assert isinstance(caught.value.reason, GroundNotRead)


def test_a_cycle_that_cannot_be_read_is_told() -> None:
    ros, _ = asked('{"run_id": "r"}')
    with pytest.raises(TmsError) as caught:
        work(ros, DAY, None)
    assert isinstance(caught.value.reason, CyclesNotRead)
