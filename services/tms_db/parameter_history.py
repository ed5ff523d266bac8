"""The last changes of each record, with their time and source: a short memory for people, not a log.

Kept in memory and stored now and then, so that it costs a fast record next to nothing; a crash may lose the last ones.
"""

import threading
from collections.abc import Mapping
from datetime import datetime
from typing import Any

import bson
from pymongo import UpdateOne

from tms_db.connection import StoreConnection
from tms_db.record_cache import Key
from tms_db.records import Value
from tms_db.store import Db, errors
from tms_db.worker import Worker
from tms_reason.errors import DbError
from tms_runtime.log import Logger

KEPT = 50  # changes a record
ROOM = 3 * 2**20  # bytes; the store takes documents of 16 MB, see `_room`
END_LIMIT = 1.0  # s that the last write may take
WRITE_PERIOD = 2.0  # s between rounds of writes; what sensing changes in between counts as one change
AT_ONCE, PAUSE = 5, 0.1  # records a write, and s between those of a round: the store takes 2 ms each, readers wait

Change = dict[str, Any]  # stamp, source, values


class ParameterHistory:
    """The `parameter_history` collection: one document a record."""

    def __init__(self, db: Db, connection: StoreConnection, log: Logger) -> None:
        self._stored, self._connection, self._log = db["parameter_history"], connection, log
        self._lock = threading.Lock()
        self._storing = threading.Lock()  # while changes are on their way from memory to the store
        self._new: dict[Key, list[Change]] = {}
        self._round: list[Key] = []  # still to be written in this round
        self._unclear = set[Key]()  # it is not known whether an earlier write of these was done
        self._worker = Worker("past", self._run, first=WRITE_PERIOD, finish=True)

    def start(self) -> None:
        self._worker.start()

    def stop(self) -> None:
        self._worker.stop(END_LIMIT)

    def note(self, key: Key, stamp: datetime, source: str, values: Mapping[str, Value], often: bool = False) -> None:
        """Remember one change; returns at once. `often`: it is merged into the last change of the same source."""
        stamp = stamp.replace(microsecond=stamp.microsecond // 1000 * 1000)  # the store keeps milliseconds
        change = {"stamp": stamp, "source": source, "values": dict(values)}
        with self._lock:
            changes = self._new.setdefault(key, [])
            if often and changes and changes[-1]["source"] == source:
                change["values"] = {**changes.pop()["values"], **values}
            changes.append(change)
            del changes[:-KEPT]

    def changes(self, key: Key, limit: int = 0) -> list[Change]:
        """Changes of a record, newest first.

        Raises:
            DbError: the store is away.
        """
        with self._storing:
            with self._lock:
                new = list(self._new.get(key, ()))
            stored = self._load(key)
        return [*stored, *_others(new, stored)][-KEPT:][::-1][: limit or KEPT]

    def _load(self, key: Key) -> list[Change]:
        with errors():
            found = self._stored.find_one({"model_name": key[0], "record_name": key[1]}) or {}
        changes: list[Change] = found.get("changes", [])
        return changes

    def _run(self) -> float:
        ending = self._worker.stopping
        if ending or not self._round:
            self._round = list(self._new)
        some = self._round if ending else self._round[:AT_ONCE]
        self._round = self._round[len(some) :]
        with self._storing:
            self._store_new(some)
        return PAUSE if self._round else WRITE_PERIOD

    def _store_new(self, keys: list[Key]) -> None:
        with self._lock:
            new = {key: self._new.pop(key) for key in keys if key in self._new}
        try:
            if new:
                with self._connection.use():
                    self._save(self._missing(new))
                self._unclear -= new.keys()
        except DbError as error:  # kept in memory until the store is back
            self._log.info("history_waits", reason=error.reason)
            self._unclear |= new.keys()
            self._round = []  # the next one begins after a while, with all of them
            with self._lock:
                for key, changes in new.items():
                    self._new[key] = [*changes, *self._new.get(key, [])][-KEPT:]

    def _missing(self, new: Mapping[Key, list[Change]]) -> dict[Key, list[Change]]:
        """Changes that an earlier write has not stored: pushed twice, they would be listed twice."""
        found = {key: _others(old, self._load(key)) if key in self._unclear else old for key, old in new.items()}
        return {key: changes for key, changes in found.items() if changes}

    def _save(self, new: Mapping[Key, list[Change]]) -> None:
        steps = [
            UpdateOne(
                {"model_name": model, "record_name": record},
                {"$push": {"changes": {"$each": changes[-room:], "$slice": -room}}},
                upsert=True,
            )
            for (model, record), changes in new.items()
            if (room := _room(changes))
        ]
        if steps:
            with errors():
                self._stored.bulk_write(steps, ordered=False)


def _room(changes: list[Change]) -> int:
    """How many changes may be kept together with these; none when one of them alone is too large.

    With this rule a document holds at most 4.5 times ROOM, whatever the sizes of earlier changes: the second oldest
    change has left room for two of its size, the third oldest for three, and so on.
    """
    return min(KEPT, ROOM // max(len(bson.encode(change)) for change in changes))


def _others(changes: list[Change], stored: list[Change]) -> list[Change]:
    return [change for change in changes if change not in stored]
