"""What is older than the site keeps goes, whole; everything else stays."""

import time
from datetime import datetime, timedelta, timezone
from typing import Any

import pytest
import structlog

from tms_config.clock import utc_now
from tms_config.site_file import SiteFile, Store
from tms_db import retention, store
from tms_db.connection import StoreConnection
from tms_db.cycles import Cycles
from tms_db.history import Event, History, Run
from tms_db.retention import Retention, delete_cycles, delete_grounds, delete_runs, delete_states
from tms_db.terrain import GROUND, Terrain
from tms_reason.errors import DbError
from tms_soil.patches import EACH_HOUR
from tms_work.cycle import Cycle

NOW = datetime(2026, 1, 31, 6, 0, tzinfo=timezone.utc)


def write(db: store.Db, run_id: str, days: float | None, started: float = 500.0) -> None:
    """A run that ended so many days ago, or has not ended, with three events."""
    ended = None if days is None else NOW - timedelta(days=days)
    begin = NOW - timedelta(days=started)
    run = Run(run_id, 4, "text", "success", "", ("zx200",), begin, ended)
    History(db).write([run], [Event(run_id, number, begin, "node") for number in (1, 2, 3)])


def left(db: store.Db) -> list[str]:
    """Runs that are there, each of them whole."""
    runs = sorted(run.run_id for run in History(db).runs())
    assert sorted(set(db["event"].distinct("run_id"))) == runs
    for run in runs:
        assert [event.number for event in History(db).events(run)] == [1, 2, 3]
    return runs


def test_old_runs_go_whole_and_others_stay_whole(db: store.Db, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(retention, "ROUND", 2)
    for number in range(5):
        write(db, f"old{number}", 30.01 + number)
    write(db, "young", 29.99)
    write(db, "new", 0.0)
    write(db, "active", None)  # for 500 days: interrupted, and somebody may want to resume it
    assert delete_runs(db, 30, NOW) == 5
    assert left(db) == ["active", "new", "young"]
    assert delete_runs(db, 30, NOW) == 0


def test_a_clock_that_is_ahead_deletes_nothing(db: store.Db) -> None:
    for days in (0.0, 10.0, 29.0):
        write(db, f"r{days:.0f}", days)
    assert delete_runs(db, 30, NOW + timedelta(days=3650)) == 0
    assert left(db) == ["r0", "r10", "r29"]
    assert delete_runs(db, 20, NOW + timedelta(days=3650)) == 1


def test_an_empty_history_is_no_trouble(db: store.Db) -> None:
    write(db, "active", None)
    assert delete_runs(db, 1, NOW) == 0
    assert delete_states(db, 1, NOW) == 0


def test_a_deletion_that_was_cut_off_is_finished_next_time(db: store.Db) -> None:
    write(db, "old", 40)
    write(db, "new", 0)
    db["event"].delete_many({"run_id": "old", "number": {"$lt": 3}})
    assert delete_runs(db, 30, NOW) == 1
    assert left(db) == ["new"]


def state(days: float, zone: bool = True) -> dict[str, Any]:
    text = (NOW - timedelta(days=days)).isoformat()
    return {"time": text if zone else text.removesuffix("+00:00"), "type": "machine_pose", "id": 3012, "msg": {}}


def test_old_states_of_machines_go(db: store.Db, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(retention, "MANY", 2)
    db["machine_pose"].insert_many([state(days, zone) for days in (0.0, 6.0, 8.0, 9.0, 40.0) for zone in (True, False)])
    db["machine_joints"].insert_many([state(days) for days in (100.0, 106.0)])  # the site slept
    assert delete_states(db, 7, NOW) == 6
    assert db["machine_pose"].count_documents({}) == 4
    assert db["machine_joints"].count_documents({}) == 2


def test_a_state_without_a_readable_time_is_told(db: store.Db) -> None:
    db["machine_pose"].insert_one({"time": "0 yesterday"})
    with pytest.raises(DbError, match="has the time '0 yesterday', which is none"):
        delete_states(db, 7, NOW)


def test_old_cycles_go(db: store.Db, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(retention, "MANY", 2)
    end = [NOW - timedelta(days=days) for days in (0.0, 6.9, 7.1, 9.0, 40.0)]
    Cycles(db).write([
        Cycle(run_id="r", machine="zx200", number=number, kind="dig", begun_at=at, ended_at=at, parts={})
        for number, at in enumerate(end, 1)
    ])  # fmt: skip
    assert delete_cycles(db, 7, NOW + timedelta(days=3650)) == 3, "a clock that is ahead deletes no more"
    assert [one.number for one in Cycles(db).find()] == [2, 1]
    assert delete_cycles(db, 7, NOW) == 0


def test_old_snapshots_of_the_ground_go_and_the_newest_stays(shared_db: store.Db) -> None:
    grounds = Terrain(shared_db)
    assert delete_grounds(shared_db, 1, NOW) == 0
    for days in (100.0, 106.9, 107.1, 140.0):  # the site slept
        grounds.put(GROUND, GROUND, b"heights", {"taken_at": (NOW - timedelta(days=days)).isoformat()})
    grounds.put(GROUND, "static", b"a file of the site that only has this name", {})
    assert delete_grounds(shared_db, 7, NOW) == 2
    assert len(grounds.all(GROUND)) == 2 and len(grounds.all("static")) == 1
    assert shared_db["fs.chunks"].count_documents({}) == 3


def test_hourly_grounds_go_with_the_recordings_that_need_them(shared_db: store.Db) -> None:
    grounds = Terrain(shared_db)
    for days, source in [(0.0, EACH_HOUR), (8.0, EACH_HOUR), (9.0, "survey.laz"), (10.0, EACH_HOUR)]:
        facts = {"taken_at": (NOW - timedelta(days=days)).isoformat(), "source": source}
        grounds.put(GROUND, GROUND, b"heights", facts)
    assert delete_grounds(shared_db, 7, NOW, EACH_HOUR) == 2
    assert {file.more["source"] for file in grounds.all(GROUND)} == {EACH_HOUR, "survey.laz"}


def test_the_index_is_used(shared_db: store.Db) -> None:
    """A daily look must not read all of a long history."""
    indexes = shared_db["run"].index_information()
    assert [("ended_at", 1)] in [one["key"] for one in indexes.values()]
    assert [("ended_at", 1)] in [one["key"] for one in shared_db["cycle"].index_information().values()]
    assert [("run_id", 1), ("number", 1)] in [one["key"] for one in shared_db["event"].index_information().values()]


def test_it_looks_by_itself_once_the_store_is_there(shared_db: store.Db, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(retention, "FIRST", 0.01)
    monkeypatch.setattr(retention, "AGAIN", 0.01)
    ended = utc_now()
    runs = [
        Run(name, 1, "", "success", "", (), ended, ended - timedelta(days=days)) for name, days in (("a", 9), ("b", 0))
    ]
    History(shared_db).write(runs, [])
    log = structlog.stdlib.get_logger("test")
    connection = StoreConnection(shared_db, "test", log)
    Cycles(shared_db).write([
        Cycle(run_id="r", machine="zx200", number=days + 1, kind="dig", begun_at=at, ended_at=at, parts={})
        for days in (9, 0)
        for at in (ended - timedelta(days=days),)
    ])  # fmt: skip
    Terrain(shared_db).put(GROUND, GROUND, b"heights", {"taken_at": (ended - timedelta(days=9)).isoformat()})
    settings = Store(history_days=7, work_days=7, ground_days=7)
    watch = Retention(shared_db, connection, settings, log)
    watch.start()  # before there is a connection
    connection.start()
    deadline = time.monotonic() + 20
    while len(History(shared_db).runs()) > 1 and time.monotonic() < deadline:
        time.sleep(0.01)
    while len(Cycles(shared_db).find()) > 1 and time.monotonic() < deadline:
        time.sleep(0.01)
    there = [run.run_id for run in History(shared_db).runs()]
    cycles, grounds = Cycles(shared_db).find(), Terrain(shared_db).all(GROUND)
    watch.stop()
    connection.stop()
    assert there == ["b"] and [one.number for one in cycles] == [1]
    assert len(grounds) == 1, "the only one stays, however old it is"


@pytest.mark.parametrize(
    "given", [{"history_days": 0}, {"history_days": -1}, {"machine_state_days": 0.5}, {"work_days": 0}]
)
def test_what_a_site_may_not_say(given: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"greater than|valid integer"):
        Store.model_validate(given)


def test_a_year_is_kept_unless_the_site_says_otherwise() -> None:
    assert (Store().history_days, Store().machine_state_days) == (365, None)
    assert (Store().work_days, Store().ground_days) == (None, None)
    site = {"name": "x", "domain": 1, "services": {}, "store": {"history_days": None}}
    assert SiteFile.model_validate(site).store.history_days is None
