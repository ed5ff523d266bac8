"""The history of runs: kept in a file of this PC first, then written through TMS_DB by a thread of its own.

A tick never waits for the database, and nothing is lost while the database is away or when this process is killed:
what was not delivered is delivered in order later, if need be by the next process. Writing an entry twice changes
nothing in the database. An entry that the database will never take is dropped, so that the others do not wait for it.
"""

import base64
import logging
import threading
import time
from pathlib import Path

from prometheus_client import Counter, Gauge
from tms_msg_db.msg import Event, Run
from tms_msg_db.srv import WriteJournal

from tms_core.errors import DbError, RosError
from tms_core.ros import Ros, pack, unpack
from tms_ts.spool import Spool

BATCH = 200
RETRY = 0.5  # s
GATHER = 0.1  # s from the first entry to its writing: ten calls beside a hand-over make it half as long again
KINDS = {b"R": Run, b"E": Event}
LARGEST = 16 * 2**20  # bytes of an entry: the store takes no larger document, and ROS carries none in good time
# What is wrong with the store, not with an entry: it passes, or a person mends it.
MAY_PASS = {"STORE_DOWN", "STORE_FULL", "STORE_REFUSED", "STORE_NEWER", "STORE_CONFLICT", "DB_FAILED", "BUSY"}

WAITING = Gauge("tms_ts_journal_waiting_bytes", "Journal entries not yet written to the database")
LOST = Counter("tms_ts_journal_lost_total", "Journal entries that could not be kept on disk, or not be stored at all")


class Journal:
    """Keeps the order; repeats a batch until the database has it."""

    def __init__(self, ros: Ros, log: logging.Logger, state: Path) -> None:
        self._ros, self._log = ros, log
        self._spool = Spool(state / "ts" / "journal")
        self._news, self._urgent = threading.Event(), threading.Event()
        self._closing = threading.Event()
        self._away = False  # the database; told
        self._thread = threading.Thread(target=self._write, name="journal", daemon=True)
        self._thread.start()

    def put(self, entry: Run | Event) -> None:
        """Take an entry; waits for nobody."""
        kind = b"R" if isinstance(entry, Run) else b"E"
        data = pack(entry)
        if len(data) > LARGEST:
            self._lost(entry.run_id, f"an entry of {len(data)} bytes, allowed are {LARGEST}")
            return
        try:
            self._spool.put(kind + base64.b64encode(data))
        except OSError as error:
            self._lost(entry.run_id, str(error))
        if isinstance(entry, Run) or entry.kind == "tree":  # somebody looks at a run that begins or ends
            self._urgent.set()
        self._news.set()

    def close(self) -> None:
        """Give the last entries a moment to be written; the rest waits on disk."""
        deadline = time.monotonic() + 0.5
        while self._spool.waiting() and time.monotonic() < deadline:
            time.sleep(0.01)
        self._closing.set()

    def _write(self) -> None:
        most = BATCH
        while not self._closing.is_set():
            lines, end = self._spool.batch(most)
            WAITING.set(self._spool.waiting())
            if not lines:
                self._gather()
                continue
            problem = self._deliver(lines)
            if problem is None:
                self._spool.done(end)
                most, self._away = min(2 * most, BATCH), False
                continue
            if not self._passes(problem):
                if len(lines) == 1:
                    entry = self._entry(lines[0])
                    self._lost(entry.run_id if entry else "", str(problem))
                    self._spool.done(end)
                most = max(1, len(lines) // 2)  # one of them is refused for good: which one?
            self._closing.wait(RETRY)  # also then: a database that is just ending may refuse anything

    def _gather(self) -> None:
        """Wait for news, and a moment longer for what comes right after."""
        if self._news.wait(0.2):
            self._news.clear()
            self._urgent.wait(GATHER)
            self._urgent.clear()

    def _passes(self, problem: DbError | RosError) -> bool:
        """Whether the same entries can be written later; told once."""
        passes = isinstance(problem, RosError) or problem.code in MAY_PASS
        if passes and not self._away:
            self._log.warning("event=journal_waits reason=%r", str(problem))
        self._away = passes
        return passes

    def _lost(self, run_id: str, reason: str) -> None:
        LOST.inc()
        self._log.error("event=journal_lost run=%s reason=%r", run_id, reason)

    def _deliver(self, lines: list[bytes]) -> DbError | RosError | None:
        """Write a batch; returns why it could not be written."""
        request = WriteJournal.Request()
        for line in lines:
            entry = self._entry(line)
            if isinstance(entry, Run):
                request.runs.append(entry)
            elif entry is not None:
                request.events.append(entry)
        try:
            answer = self._ros.call(WriteJournal, "/tms/db/write_journal", request)
        except RosError as error:
            return error
        return DbError(answer.error_msg, answer.error_code) if answer.error_code else None

    def _entry(self, line: bytes) -> Run | Event | None:
        try:
            entry: Run | Event = unpack(base64.b64decode(line[1:], validate=True), KINDS[line[:1]])
        except (KeyError, ValueError, RuntimeError) as error:
            if line:
                self._log.error("event=journal_unreadable reason=%r", str(error))
            return None
        return entry
