"""Deletes what is older than the site keeps: runs with all events, states of machines, recordings, cycles, grounds.

A run goes whole or stays whole. One that has not ended (active, or interrupted and still to be resumed) stays, and so
do all tasks and records. Ages count back from the newest run as well as from the clock: a clock that is years ahead,
or a site that slept for years, loses nothing.
"""

from datetime import datetime, timedelta, timezone

from prometheus_client import Counter

from tms_config.clock import utc_now
from tms_config.site_file import Store
from tms_db import store
from tms_db.connection import StoreConnection
from tms_db.cycles import COLLECTION as CYCLE
from tms_db.machine_states import COLLECTIONS
from tms_db.reasons import NoStateTime
from tms_db.recordings import COLLECTION as RECORDING
from tms_db.store import Db, errors
from tms_db.terrain import GROUND, Terrain
from tms_db.worker import Worker
from tms_reason.errors import DbError
from tms_runtime.log import Logger
from tms_soil.patches import EACH_HOUR

FIRST = 1.0  # s from the start to the first round: the store is up by then, as a rule
RETENTION_PERIOD = 24 * 3600.0  # s between rounds
AGAIN = 60.0  # s after a round that the store refused, or that began before the store was up
ROUND = 100  # runs at a time, so that the store serves other requests in between
MANY = 1000  # states at a time

DELETED = Counter("tms_db_deleted", "Documents deleted for their age", ["collection"])


def delete_runs(db: Db, days: int, now: datetime) -> int:
    """Delete runs that ended more than `days` ago, with their events. Returns how many runs.

    Raises:
        DbError: the store is away; the next round deletes the rest of a run whose events are partly deleted.
    """
    runs, events, deleted = db["run"], db["event"], 0
    with errors():
        newest = runs.find_one({"ended_at": {"$ne": None}}, {"ended_at": 1}, sort=[("ended_at", -1)])
    if newest is None:
        return 0
    before = min(now, newest["ended_at"]) - timedelta(days=days)
    while True:
        with store.long_work(db):
            old = list(runs.find({"ended_at": {"$lt": before}}, {"run_id": 1}).limit(ROUND))
            for run in old:  # its header last: after a crash the next round finds the remaining events by it
                DELETED.labels("event").inc(events.delete_many({"run_id": run["run_id"]}).deleted_count)
                runs.delete_one({"_id": run["_id"]})
        deleted += len(old)
        DELETED.labels("run").inc(len(old))
        if len(old) < ROUND:
            return deleted


def delete_states(db: Db, days: int, now: datetime) -> int:
    """Delete states of machines that are older than `days`. Returns how many.

    Raises:
        DbError: the store is away.
    """
    deleted = 0
    for name in COLLECTIONS:
        with errors():
            newest = db[name].find_one({}, {"time": 1}, sort=[("time", -1)])
        if newest is None or not isinstance(newest.get("time"), str):
            continue
        # ISO texts sort as the times do. The C++ system writes local time, so a state may go some hours early.
        before = _date(min(now.isoformat(), newest["time"])) - timedelta(days=days)
        deleted += _delete_before(db, name, before.isoformat())
    return deleted


def delete_cycles(db: Db, days: int, now: datetime) -> int:
    """Delete cycles of work that ended more than `days` ago. Returns how many.

    Raises:
        DbError: the store is away.
    """
    return _delete_older(db, CYCLE, "ended_at", days, now)


def delete_recordings(db: Db, days: int, now: datetime) -> int:
    """Delete what machines told more than `days` ago while runs were active. Returns how many pieces.

    Raises:
        DbError: the store is away.
    """
    return _delete_older(db, RECORDING, "begin", days, now)


def delete_grounds(db: Db, days: int, now: datetime, source: str | None = None) -> int:
    """Delete snapshots of the ground (of a source) older than `days`, but never the newest one. Returns how many.

    Raises:
        DbError: the store is away.
    """
    terrain = Terrain(db)
    taken = [(file, datetime.fromisoformat(file.more["taken_at"])) for file in terrain.all(GROUND, GROUND)]
    newest = max((time for _, time in taken), default=now)
    before = min(now, newest) - timedelta(days=days)
    old = [file for file, time in taken if time < before and source in (None, file.more.get("source"))]
    for file in old:
        terrain.delete(file)
    DELETED.labels(GROUND).inc(len(old))
    return len(old)


def _delete_older(db: Db, collection: str, field: str, days: int, now: datetime) -> int:
    """Delete what is older than `days` by a field; ages count back from the newest one as well."""
    with errors():
        newest = db[collection].find_one({}, {field: 1}, sort=[(field, -1)])
    if newest is None:
        return 0
    return _delete_before(db, collection, min(now, newest[field]) - timedelta(days=days), field)


def _delete_before(db: Db, collection: str, time: str | datetime, field: str = "time") -> int:
    deleted, last = 0, MANY
    while last == MANY:
        with store.long_work(db):
            old = [state["_id"] for state in db[collection].find({field: {"$lt": time}}, {"_id": 1}).limit(MANY)]
            db[collection].delete_many({"_id": {"$in": old}})
        last = len(old)
        deleted += last
        DELETED.labels(collection).inc(last)
    return deleted


def _date(text: str) -> datetime:
    try:
        return datetime.fromisoformat(text).replace(tzinfo=timezone.utc)
    except ValueError:
        raise DbError(NoStateTime(str(text)), "BAD_RECORD") from None


class Retention:
    """Deletes when the store is up for the first time, and then once a day."""

    def __init__(self, db: Db, connection: StoreConnection, settings: Store, log: Logger) -> None:
        self._db, self._connection, self._settings, self._log = db, connection, settings, log
        self._worker = Worker("retention", self._run, first=FIRST)

    def start(self) -> None:
        self._worker.start()

    def stop(self) -> None:
        self._worker.stop()

    def _run(self) -> float:
        try:
            with self._connection.use():
                self._delete_old(utc_now())
        except DbError as error:
            if error.code != "STORE_DOWN":  # which the connection logs
                self._log.warning("retention_waits", code=error.code, reason=error.reason)
            return AGAIN
        return RETENTION_PERIOD

    def _delete_old(self, now: datetime) -> None:
        gone: dict[str, int] = {}
        if self._settings.history_days is not None:
            gone["runs"] = delete_runs(self._db, self._settings.history_days, now)
        if self._settings.machine_state_days is not None:
            gone["machine_states"] = delete_states(self._db, self._settings.machine_state_days, now)
        if self._settings.work_days is not None:
            gone["cycles"] = delete_cycles(self._db, self._settings.work_days, now)
        if self._settings.ground_days is not None:
            gone["grounds"] = delete_grounds(self._db, self._settings.ground_days, now)
        if self._settings.recording_days is not None:
            gone["recordings"] = delete_recordings(self._db, self._settings.recording_days, now)
            gone["hours"] = delete_grounds(self._db, self._settings.recording_days, now, EACH_HOUR)
        if any(gone.values()):
            self._log.info("retention", reason=" ".join(f"{what}={number}" for what, number in gone.items()))
