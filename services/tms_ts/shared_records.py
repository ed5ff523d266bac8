"""The scheduler's copy of shared records (the global blackboard): a leaf that waits for a flag does not call tms:db.

A record is read once and kept until tms:db publishes a change of it, or for KEPT at most: another program may write to
the store without tms:db, and a message may get lost with a process.
"""

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tms_msg_db.msg import RecordChanges

from tms_config.clock import monotonic
from tms_ros.node import Ros

KEPT = 1.0  # s
CHANGES_KEPT = 100  # messages about changes that may wait


@dataclass(frozen=True)
class Kept:
    """A record as it was read."""

    fields: dict[str, Any]
    until: float  # monotonic


class SharedRecords:
    """Used by the threads of all runs and by the executor."""

    def __init__(self, ros: Ros) -> None:
        self._lock = threading.Lock()
        self._kept: dict[str, Kept] = {}
        self._changes: dict[str, int] = {}  # how often each record has changed
        self._readers: dict[str, set[Callable[[], None]]] = {}
        ros.subscribe(RecordChanges, "/tms/db/changes", self._changed, depth=CHANGES_KEPT)

    def kept(self, record: str) -> dict[str, Any] | None:
        """The fields of a record, if they are known."""
        with self._lock:
            found = self._kept.get(record)
            return found.fields if found is not None and monotonic() < found.until else None

    def asked(self, record: str) -> int:
        """Call it before reading a record: with its result, `keep` detects a change meanwhile."""
        with self._lock:
            return self._changes.get(record, 0)

    def keep(self, record: str, asked: int, fields: dict[str, Any], max_age: float) -> None:
        """Keep a record that was just read, unless it can get too old: such records are read every time."""
        with self._lock:
            if self._changes.get(record, 0) == asked and max_age <= 0:
                self._kept[record] = Kept(fields, monotonic() + KEPT)

    def forget(self, record: str) -> None:
        """Drop the copy of a record that was changed."""
        with self._lock:
            self._kept.pop(record, None)
            self._changes[record] = self._changes.get(record, 0) + 1

    def watch(self, record: str, wake: Callable[[], None]) -> None:
        """Call `wake` at every change of a record."""
        with self._lock:
            self._readers.setdefault(record, set()).add(wake)

    def unwatch(self, wake: Callable[[], None]) -> None:
        """End the calls of `wake`, for all records."""
        with self._lock:
            for readers in self._readers.values():
                readers.discard(wake)
            self._readers = {record: readers for record, readers in self._readers.items() if readers}

    def _changed(self, message: RecordChanges) -> None:
        for record in message.record_names:
            self.forget(record)
            with self._lock:
                readers = list(self._readers.get(record, ()))
            for wake in readers:
                wake()
