"""Recordings in the database: joints, poses and loads of the machines while runs were active."""

import zlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

import numpy as np
from pymongo.errors import DuplicateKeyError

from tms_config.clock import utc_now
from tms_db.reasons import RecordingDamaged, RunMissing
from tms_db.recording_piece import Rows, unpacked
from tms_db.store import Db, errors
from tms_reason.errors import DbError

COLLECTION = "recording"
PIECE = 10.0  # s, of one piece
TAIL = 10.0  # s after a run for which machines are still recorded: they stand, tip over, are driven away
POINTS, MOST_POINTS = 2000, 20_000  # of a series
PIECES = 1000  # of a machine that are unpacked for one answer; of more, some at equal distances
LISTED = 200_000  # pieces of a machine that are looked through


@dataclass(frozen=True)
class Series:
    """What a machine told: `rows` of times [s since 1970] and values."""

    machine: str
    kind: str
    names: tuple[str, ...]
    rows: Rows


class Recordings:
    """The collection `recording`, a document a machine and piece."""

    def __init__(self, db: Db) -> None:
        self._db, self._pieces = db, db[COLLECTION]

    def write(self, documents: Iterable[Mapping[str, Any]]) -> None:
        """Store pieces; one that is there already stays.

        Raises:
            DbError: the store is away; then all may be sent again.
        """
        for one in documents:
            with errors():
                try:
                    self._pieces.insert_one(dict(one))
                except DuplicateKeyError:  # the answer to its first writing was lost
                    continue

    def span(self, run_id: str) -> tuple[datetime, datetime]:
        """From when to when a run was recorded.

        Raises:
            DbError: RUN_MISSING.
        """
        with errors():
            run = self._db["run"].find_one({"run_id": run_id}, {"started_at": 1, "ended_at": 1})
        if run is None:
            raise DbError(RunMissing(run_id))
        return run["started_at"], (run["ended_at"] or utc_now()) + timedelta(seconds=TAIL)

    def machines(self, begin: datetime, end: datetime) -> list[str]:
        """Machines that were recorded between two times, by name."""
        with errors():
            return sorted(self._pieces.distinct("machine", _between(begin, end)))

    def read(self, machine: str, begin: datetime, end: datetime, points: int) -> list[Series]:
        """What a machine told between two times, at most `points` rows of each kind.

        Raises:
            DbError: the store is away, or a piece is damaged.
        """
        rows: dict[tuple[str, tuple[str, ...]], list[Rows]] = {}
        for piece in self._chosen({"machine": machine, **_between(begin, end)}):
            for key, found in _series(machine, piece):
                rows.setdefault(key, []).append(found)
        series = []
        for (kind, names), parts in rows.items():
            found = np.concatenate(parts)
            inside = (found[:, 0] >= begin.timestamp()) & (found[:, 0] <= end.timestamp())
            if len(thin := thinned(found[inside], points)):
                series.append(Series(machine, kind, names, thin))
        return sorted(series, key=lambda one: (one.kind, one.names))

    def _chosen(self, query: dict[str, Any]) -> Iterable[dict[str, Any]]:
        with errors():
            listed = list(self._pieces.find(query, {"_id": 1}).sort("begin", 1).limit(LISTED))
            stride = -(-len(listed) // PIECES) or 1
            ids = [one["_id"] for one in listed[::stride]]
            yield from self._pieces.find({"_id": {"$in": ids}}).sort("begin", 1)


def _between(begin: datetime, end: datetime) -> dict[str, Any]:
    return {"begin": {"$gte": begin - timedelta(seconds=2 * PIECE), "$lte": end}}


def _series(machine: str, piece: dict[str, Any]) -> list[tuple[tuple[str, tuple[str, ...]], Rows]]:
    found = []
    for kind, stored in piece["series"].items():
        try:
            rows = unpacked(stored)
        except (ValueError, KeyError, zlib.error) as error:
            raise DbError(RecordingDamaged(machine, str(piece["begin"]), str(error)), "BAD_RECORD") from error
        rows[:, 0] += piece["begin"].timestamp()
        found.append(((kind, tuple(stored["names"])), rows))
    return found


def thinned(rows: Rows, most: int) -> Rows:
    """At most so many rows, the first and the last among them, at equal distances."""
    if len(rows) <= most:
        return rows
    return rows.take(np.linspace(0, len(rows) - 1, most).round().astype(int), axis=0)
