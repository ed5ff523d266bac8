"""History in the database: runs and their events in order; writing a batch twice changes nothing."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

from pymongo.errors import BulkWriteError, DuplicateKeyError

from tms_db.reasons import BadRunId, NoEventNumber, RivalScheduler, RunMissing
from tms_db.records import Value
from tms_db.store import Db, errors
from tms_reason import names
from tms_reason.errors import DbError

RUNS = 50
EVENTS = 1000
MAX_EVENTS = 10_000  # events in one answer, so that it stays a few MB
ATTEMPTS = 20


@dataclass(frozen=True)
class Run:
    """Header of one run; `ended_at` is None while it runs."""

    run_id: str
    task_id: int
    description: str
    state: str
    reason: str
    machines: tuple[str, ...]
    started_at: datetime
    ended_at: datetime | None
    records: tuple[str, ...] = ()  # records that the tree names: MODEL/RECORD; MODEL/* where only the run decides
    values: dict[str, Value] = field(default_factory=dict)  # further facts that the scheduler records


@dataclass(frozen=True)
class Event:
    """One entry of a run's journal; `number` counts from 1 in each run."""

    run_id: str
    number: int
    stamp: datetime
    kind: str
    node: str = ""
    text: str = ""
    values: dict[str, Value] = field(default_factory=dict)


class History:
    """The `run` and `event` collections."""

    def __init__(self, db: Db) -> None:
        self._runs, self._events = db["run"], db["event"]

    def write(self, runs: Sequence[Run], events: Sequence[Event]) -> None:
        """Store run headers (the last one counts) and events.

        The end of a run is written after its events: the journal of a run with an end is complete.

        Raises:
            DbError: BAD_JOURNAL, or the store is away; then the whole batch may be sent again.
        """
        for run in runs:
            _check_id(run.run_id)
        for event in events:
            _check(event)
        self._write_runs(run for run in runs if run.ended_at is None)
        self._write_events(events)
        self._write_runs(run for run in runs if run.ended_at is not None)

    def runs(self, limit: int = 0) -> list[Run]:
        """Runs, newest first."""
        with errors():
            found = self._runs.find({}, {"_id": 0}).sort([("started_at", -1), ("run_id", -1)])
            return [_run(document) for document in found.limit(min(limit or RUNS, MAX_EVENTS))]

    def events(self, run_id: str, after: int = 0, limit: int = 0) -> list[Event]:
        """Events of a run with a number above `after`, in order.

        Raises:
            DbError: RUN_MISSING.
        """
        with errors():
            found = self._events.find({"run_id": run_id, "number": {"$gt": after}}, {"_id": 0}).sort("number", 1)
            events = [_event(document) for document in found.limit(min(limit or EVENTS, MAX_EVENTS))]
            if not events and self._runs.find_one({"run_id": run_id}, {"_id": 1}) is None:
                raise DbError(RunMissing(run_id))
        return events

    def _write_runs(self, runs: Iterable[Run]) -> None:
        for run in runs:
            lists = {"machines": list(run.machines), "records": list(run.records), "values": _pairs(run.values)}
            document = {**vars(run), **lists}
            for _ in range(ATTEMPTS):
                with errors():
                    try:
                        self._runs.replace_one({"run_id": run.run_id}, document, upsert=True)
                        break
                    except DuplicateKeyError:  # two upserts of a new run at the same time: it exists now
                        continue
            else:
                raise _rival()

    def _write_events(self, events: Sequence[Event]) -> None:
        for _ in range(ATTEMPTS):
            missing = self._not_stored(events)
            if not missing:
                return
            with errors():
                try:
                    self._events.insert_many(missing)
                    return
                except BulkWriteError as error:
                    if any(one.get("code") != 11000 for one in error.details["writeErrors"]):
                        raise
        raise _rival()

    def _not_stored(self, events: Sequence[Event]) -> list[dict[str, Any]]:
        by_key = {(event.run_id, event.number): event for event in events}
        for run_id in {event.run_id for event in events}:
            numbers = [number for run, number in by_key if run == run_id]
            span = {"$gte": min(numbers), "$lte": max(numbers)}
            with errors():
                for stored in self._events.find({"run_id": run_id, "number": span}, {"number": 1}):
                    by_key.pop((run_id, stored["number"]), None)
        return [_document(event) for event in by_key.values()]


def _check(event: Event) -> None:
    _check_id(event.run_id)
    if event.number < 1:
        raise DbError(NoEventNumber(event.number, event.run_id), "BAD_JOURNAL")


def _check_id(run_id: str) -> None:
    if (why := names.name_flaw(run_id)) is not None:
        raise DbError(BadRunId(run_id[:40], why), "BAD_JOURNAL")


def _pairs(values: dict[str, Value]) -> list[dict[str, Any]]:
    # Names of values may hold what field names may not (dots, a leading $).
    return [{"name": name, "value": value} for name, value in values.items()]


def _values(pairs: Iterable[dict[str, Any]]) -> dict[str, Value]:
    return {pair["name"]: pair["value"] for pair in pairs}


def _document(event: Event) -> dict[str, Any]:
    return {**vars(event), "values": _pairs(event.values)}


def _event(document: dict[str, Any]) -> Event:
    return Event(**{**document, "values": _values(document["values"])})


def _rival() -> DbError:
    return DbError(RivalScheduler(), "BUSY")


def _run(document: dict[str, Any]) -> Run:
    lists = {"machines": tuple(document["machines"]), "records": tuple(document.get("records", ()))}
    return Run(**{**document, **lists, "values": _values(document.get("values", ()))})
