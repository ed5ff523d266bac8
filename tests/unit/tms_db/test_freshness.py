"""Old values are refused; those of a locked record are as old as they were when it was locked."""

from datetime import datetime, timedelta, timezone

import pytest

from tms_db.freshness import check
from tms_machine.record_lock import LEASE, released, taken
from tms_reason.errors import DbError

NOW = datetime(2026, 1, 31, 6, 0, tzinfo=timezone.utc)


def record(age: float, **fields: object) -> dict[str, object]:
    given = {"model_name": "zx200", "record_name": "p", "type": "dynamic", "max_age": 2.0, "source": "sp"}
    return {**given, "updated_at": NOW - timedelta(seconds=age), **fields}


def locked(ago: float, age: float) -> dict[str, object]:
    """Locked `ago` seconds before NOW, when the values were `age` seconds old."""
    return record(ago + age, **taken("plan", NOW.timestamp() - ago))


def test_old_values_are_refused_with_age_and_limit() -> None:
    check(record(1.9), 0.0, NOW)
    with pytest.raises(DbError, match=r"record zx200/p is 2\.1 s old, allowed are 2.0 s \(last from sp\)"):
        check(record(2.1), 0.0, NOW)
    check(record(2.1), 5.0, NOW)
    check(record(99.0), -1.0, NOW)
    check(record(99.0, type="static"), 0.0, NOW)


def test_what_was_fresh_when_it_was_locked_may_be_moved_with() -> None:
    check(locked(ago=40.0, age=1.0), 0.0, NOW)
    with pytest.raises(DbError, match=r"3\.0 s old"):
        check(locked(ago=40.0, age=3.0), 0.0, NOW)


def test_a_lock_that_has_ended_keeps_nothing_fresh() -> None:
    for fields in (locked(ago=LEASE, age=1.0), record(41.0, **released())):
        with pytest.raises(DbError, match="s old"):
            check(fields, 0.0, NOW)


def test_a_time_in_the_future_tells_no_age() -> None:
    check(record(-1.9), 0.0, NOW)  # less than what is allowed either way
    for fields in (record(-60.0), record(-60.0, **taken("plan", NOW.timestamp()))):
        with pytest.raises(DbError, match=r"its time lies in the future.*let sensing write it") as refused:
            check(fields, 0.0, NOW)
        assert refused.value.code == "STALE_RECORD"
    check(locked(ago=40.0, age=-30.0), 0.0, NOW)  # changed by hand while it was locked
    check(record(-60.0), -1.0, NOW)


def test_a_limit_that_is_no_number_is_none() -> None:
    check(record(99.0, max_age="2.0"), 0.0, NOW)
    with pytest.raises(DbError, match=r"99\.0 s old"):
        check(record(99.0, max_age="2.0"), 5.0, NOW)
