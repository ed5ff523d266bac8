"""Cycles are checked, and sums count each of them once, where it ended."""

from datetime import datetime, timedelta, timezone
from typing import Any

import pytest
from pydantic import ValidationError

from tms_reason.reason import Reason
from tms_reason.reasons import MissingKey
from tms_reason.validation import problems
from tms_work import sums
from tms_work.cycle import Cycle
from tms_work.reasons import EndsBeforeBegin, NoSuchPart, PartsTooLong

JAPAN = timezone(timedelta(hours=9))
BEGIN = datetime(2026, 11, 26, 8, 59, 30, tzinfo=JAPAN)


def dig(number: int, begin: datetime = BEGIN, **more: Any) -> dict[str, Any]:
    found = {
        "run_id": "r1", "machine": "zx200", "number": number, "kind": "dig", "begun_at": begin,
        "ended_at": begin + timedelta(seconds=40), "parts": {"dig": 12.0, "swing_loaded": 8.0, "dump": 6.0,
        "swing_back": 7.0, "wait_for_truck": 7.0}, "soil": "dirt", "bank": 0.6, "loose": 0.75, "mass": 1000.0,
        "fill": 0.9, "into": "ic120_1",
    }  # fmt: skip
    return found | more


def haul(number: int, begin: datetime = BEGIN, **more: Any) -> dict[str, Any]:
    found = {
        "run_id": "r1", "machine": "ic120_1", "number": number, "kind": "haul", "begun_at": begin,
        "ended_at": begin + timedelta(seconds=300), "parts": {"load": 160.0, "haul": 60.0, "tip": 20.0, "return": 60.0},
        "bank": 4.0, "loose": 5.0, "mass": 7000.0, "distance": 150.0,
    }  # fmt: skip
    return found | more


def cycles(*documents: dict[str, Any]) -> list[Cycle]:
    return [Cycle.model_validate(one) for one in documents]


def refused(**more: Any) -> tuple[str, Reason]:
    with pytest.raises(ValidationError) as caught:
        Cycle.model_validate(dig(1) | more)
    keys, reason = next(problems(caught.value))
    return ".".join(str(key) for key in keys), reason


def test_cycles_that_are_none() -> None:
    assert refused(ended_at=BEGIN - timedelta(seconds=1)) == ("ended_at", EndsBeforeBegin())
    assert refused(parts={"haul": 1.0})[0] == "parts.haul" and isinstance(refused(parts={"haul": 1.0})[1], NoSuchPart)
    assert refused(parts={"dig": 30.0, "dump": 11.0}) == ("parts", PartsTooLong(41.0, 40.0))
    assert refused(bank=-0.1)[0] == "bank" and refused(mass=float("nan"))[0] == "mass"
    assert refused(number=0)[0] == "number" and refused(machine="")[0] == "machine"
    assert refused(begun_at=BEGIN.replace(tzinfo=None))[0] == "begun_at"
    assert refused(colour="red")[0] == "colour"
    document = dig(1)
    del document["kind"]
    with pytest.raises(ValidationError) as caught:
        Cycle.model_validate(document)
    assert list(problems(caught.value)) == [(("kind",), MissingKey())]


def test_a_sum_counts_soil_once_and_carriers_beside_it() -> None:
    found = sums.total(cycles(dig(1), dig(2, fill=0.7, measured=True), dig(3, fill=None), haul(1), haul(2, loose=0.0)))
    assert (found.cycles, found.loads, found.measured) == (3, 1, 1)
    assert (found.bank, found.loose, found.mass) == (pytest.approx(1.8), pytest.approx(2.25), 3000.0)
    assert (found.hauled, found.distance, found.fill) == (5.0, 300.0, pytest.approx(0.8))
    assert found.rate == pytest.approx(0.6 / 40 * 3600) and found.mean_cycle == 40.0
    assert found.parts["wait_for_truck"] == 21.0 and found.haul_parts["haul"] == 120.0
    nothing = sums.total([])
    assert (nothing.rate, nothing.mean_cycle, nothing.fill, nothing.bank) == (None, None, None, 0)


def test_a_cycle_counts_in_the_hour_and_day_of_its_end() -> None:
    late = datetime(2026, 11, 26, 23, 59, 50, tzinfo=JAPAN)
    work = cycles(dig(1), dig(2, late), dig(3, BEGIN + timedelta(hours=1)))
    assert {name: one.cycles for name, one in sums.by(work, sums.hour(JAPAN)).items()} == {
        "2026-11-26 09": 1, "2026-11-26 10": 1, "2026-11-27 00": 1,
    }  # fmt: skip
    assert list(sums.by(work, sums.day(JAPAN))) == ["2026-11-26", "2026-11-27"]
    assert list(sums.by(work, sums.day(timezone.utc))) == ["2026-11-26"]
    assert list(sums.by(cycles(haul(1), dig(1)), lambda one: one.machine)) == ["ic120_1", "zx200"]
