"""Writes many small updates in few steps: readable at once, acknowledged when stored, the newest value wins.

The store takes about a millisecond for each update however they are sent, so the updates of one record within a
moment become one. Callers wait for the writer's next round and send again what failed.
"""

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from prometheus_client import Counter, Gauge, Histogram
from pymongo import UpdateOne
from pymongo.errors import BulkWriteError

from tms_db.connection import StoreConnection
from tms_db.reasons import ManyRecordsWait, StoreDown, StoreRefusedUpdate, StoreSlow
from tms_db.record_cache import Key
from tms_db.records import Document, Value
from tms_db.store import Db, errors
from tms_db.worker import Worker
from tms_reason.errors import DbError
from tms_runtime.log import Logger

END_LIMIT = 1.0  # s that the last round may take
LINGER = 0.25  # s that updates of sensing wait for further ones
WAITING = 10_000  # records whose updates may wait at the same time
SETTLE_LIMIT = 4.0  # s for a round of the writer, a little more than the store may take to answer

SECONDS = Histogram("tms_db_batch_seconds", "Duration of a write of many updates")
SIZE = Histogram("tms_db_batch_records", "Records in one write", buckets=(1, 2, 5, 10, 20, 50, 100, 500, 1000))
MERGED = Counter("tms_db_updates_merged_total", "Updates that a newer one replaced before they were written")
PENDING = Gauge("tms_db_updates_pending", "Records whose newest values are not stored yet")

Done = Callable[[DbError | None], None]  # called on the writer's thread


@dataclass
class Update:
    """Values on their way into one record."""

    id: Any
    fields: dict[str, Value]
    updated_at: datetime | None  # None: age and source of the record stay
    source: str

    def stored(self) -> Document:
        if self.updated_at is None:
            return self.fields
        return {**self.fields, "updated_at": self.updated_at, "source": self.source}

    def after(self, before: "Update") -> "Update":
        """Merge this update and the one before it."""
        reported = self if self.updated_at is not None else before
        return Update(self.id, {**before.fields, **self.fields}, reported.updated_at, reported.source)


class Batches:
    """Updates that are not stored yet, and the thread that stores them."""

    def __init__(self, db: Db, connection: StoreConnection, log: Logger) -> None:
        self._records, self._connection, self._log = db["parameter"], connection, log
        self._changed = threading.Condition()
        self._waiting: dict[Key, Update] = {}
        self._written: dict[Key, Update] = {}  # updates that the present round writes
        self._callers: list[Done] = []
        self.gone = threading.Event()  # set when a record did not exist any more
        self._worker = Worker("batches", self._write_round, first=math.inf, finish=True)

    def start(self) -> None:
        self._worker.start()

    def stop(self) -> None:
        """Write the waiting updates and end."""
        self._worker.stop(END_LIMIT)

    def put(self, updates: dict[Key, Update], done: Done, hurry: bool) -> None:
        """Take updates; `done` is called when they are stored, or with the error.

        Raises:
            DbError: BUSY; too many updates wait.
        """
        with self._changed:
            if len(self._waiting) > WAITING:
                raise DbError(ManyRecordsWait(), "BUSY")
            for key, update in updates.items():
                self._add(key, update)
            self._callers.append(done)
            PENDING.set(len(self._waiting))
        self._worker.wake(0.0 if hurry else LINGER)

    def _add(self, key: Key, update: Update) -> None:
        before = self._waiting.get(key)
        if before is not None and before.id == update.id:
            MERGED.inc()
            update = update.after(before)
        self._waiting[key] = update

    def newest(self, key: Key) -> Document:
        """Fields of a record that are newer than what the store has."""
        with self._changed:
            rounds = [found for found in (self._written.get(key), self._waiting.get(key)) if found is not None]
        return {name: value for update in rounds for name, value in update.stored().items()}

    def settle(self, key: Key) -> None:
        """Wait until the store has all updates of a record, for a step that the store itself must do.

        Raises:
            DbError: STORE_DOWN; it takes too long.
        """
        with self._changed:
            if key in self._waiting:
                self._worker.wake()
            if not self._changed.wait_for(lambda: not (key in self._waiting or key in self._written), SETTLE_LIMIT):
                raise DbError(StoreDown(StoreSlow()))

    def _write_round(self) -> float:
        """Store all waiting updates; returns math.inf, since `put` wakes the next round."""
        with self._changed:
            callers, self._callers = self._callers, []
            self._written, self._waiting = self._waiting, {}
            PENDING.set(0)
        problem = self._write(list(self._written.values()))
        with self._changed:
            self._written = {}
            self._changed.notify_all()
        for done in callers:
            done(problem)
        return math.inf

    def _write(self, updates: list[Update]) -> DbError | None:
        if not updates:
            return None
        SIZE.observe(len(updates))
        steps = [UpdateOne({"_id": update.id}, {"$set": update.stored()}) for update in updates]
        try:
            with SECONDS.time(), self._connection.use(), errors():
                found = self._records.bulk_write(steps, ordered=False).matched_count
        except BulkWriteError as error:  # a subclass that errors() lets pass as it is
            return DbError(StoreRefusedUpdate(str(error.details), "tms:db"), "STORE_REFUSED")
        except DbError as error:
            return error
        if found < len(updates):
            self.gone.set()
            self._log.warning("records_gone", removed=len(updates) - found, updated=len(updates))
        return None
