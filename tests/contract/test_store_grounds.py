"""Grounds of tms:ground in the store: they come back, by time; what is none is refused."""

from datetime import datetime, timedelta, timezone
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import structlog
from tms_msg_ground.srv import ReadSnapshot, WriteSnapshot

from tms_db import ground as grounds
from tms_db import store
from tms_db.ground_services import GroundServices
from tms_db.reasons import GroundNotHeights, GroundNotThere, NoZone
from tms_reason.errors import DbError
from tms_soil import patches
from tms_soil.surface import Heights

NOON = datetime(2026, 11, 26, 12, tzinfo=timezone.utc)


@pytest.fixture
def services(shared_db: store.Db, monkeypatch: pytest.MonkeyPatch) -> GroundServices:
    app: Any = SimpleNamespace(log=structlog.stdlib.get_logger("test"))
    made = GroundServices(app, shared_db)
    for hour in range(3):
        monkeypatch.setattr(grounds, "utc_now", lambda hour=hour: NOON + timedelta(hours=hour))
        answer, ground = WriteSnapshot.Response(), patches.patch(level(float(hour)))
        made.write(WriteSnapshot.Request(ground=ground, source=f"hour {hour}"), answer)
        assert answer.taken_at == (NOON + timedelta(hours=hour)).isoformat()
    return made


def level(z: float) -> Heights:
    found = Heights(-3.0, 2.0, 0.2, np.full((6, 4), z))
    found.z[0, 0] = np.nan
    return found


def read(services: GroundServices, snapshot: str, after: str = "", until: str = "") -> ReadSnapshot.Response:
    answer = ReadSnapshot.Response()
    services.read(ReadSnapshot.Request(snapshot=snapshot, after=after, until=until), answer)
    return answer


def test_they_come_back_by_time(services: GroundServices) -> None:
    last = read(services, "last")
    assert (last.source, last.taken_at) == ("hour 2", (NOON + timedelta(hours=2)).isoformat())
    found = patches.heights(last.ground)
    assert (found.x0, found.y0, found.cell) == (-3.0, 2.0, 0.2)
    assert np.array_equal(found.z, level(2.0).z, equal_nan=True)
    assert last.ground.header.stamp.sec == int((NOON + timedelta(hours=2)).timestamp())
    first = read(services, "first")
    assert first.source == "hour 0"
    assert [read(services, "first", one.taken_at).source for one in (first, read(services, "first", first.taken_at))] \
        == ["hour 1", "hour 2"]  # fmt: skip
    assert not read(services, "first", last.taken_at).taken_at, "nothing newer is no error"
    with pytest.raises(DbError) as caught:
        read(services, "1999-01-01")
    assert isinstance(caught.value.reason, GroundNotThere) and caught.value.code == "GROUND_NOT_THERE"


def test_the_ground_of_a_moment_is_the_last_until_then(services: GroundServices) -> None:
    hours = [(NOON + timedelta(hours=hour)).isoformat() for hour in range(3)]
    for minutes, hour in [(0, 0), (59, 0), (60, 1), (119, 1)]:
        found = read(services, "last", until=(NOON + timedelta(minutes=minutes)).isoformat())
        assert (found.taken_at, found.next_at) == (hours[hour], hours[hour + 1])
    assert (read(services, "last").taken_at, read(services, "last").next_at) == (hours[2], "")
    with pytest.raises(DbError) as caught:
        read(services, "last", until=(NOON - timedelta(seconds=1)).isoformat())
    assert caught.value.code == "GROUND_NOT_THERE"


@pytest.mark.parametrize("time", ["yesterday", "2026-11-26T12:00:00"])
def test_a_time_needs_its_zone(services: GroundServices, time: str) -> None:
    with pytest.raises(DbError) as caught:
        read(services, "first", time)
    assert isinstance(caught.value.reason, NoZone)


def test_what_is_no_ground_is_not_stored(services: GroundServices) -> None:
    broken = patches.patch(level(9.0))
    broken.rows = 99
    with pytest.raises(DbError) as caught:
        services.write(WriteSnapshot.Request(ground=broken), WriteSnapshot.Response())
    assert isinstance(caught.value.reason, GroundNotHeights) and read(services, "last").source == "hour 2"
