"""The history of runs: stored on the disk of this PC first, then written through TMS_DB by a thread of its own.

A tick waits for neither, and no entry is lost while the database is away: entries are delivered later, in order, if
need be by the next process. The database, and so every reader of the history, gets an entry only when it is on this
disk: a reported entry survives a power cut. Writing an entry twice does not change the database. An entry that the
database refuses for good is dropped, so that the others do not wait for it.
"""

import threading
from pathlib import Path

from prometheus_client import Counter, Gauge
from tms_msg_db.msg import Event, Run
from tms_msg_db.srv import WriteJournal

from tms_config.clock import monotonic, sleep
from tms_reason.errors import DbError, RosError
from tms_reason.reason import Foreign, Reason
from tms_reason.wire import refusal
from tms_ros.node import Ros
from tms_ros.packing import pack
from tms_runtime.log import Logger
from tms_ts.group_commit import GroupCommit
from tms_ts.journal_entry import of_line, to_line
from tms_ts.reasons import DiskFull, EntryTooLarge, HistoryInMemory, HistoryLost, JournalFull
from tms_ts.spool import Spool

BATCH = 200
RETRY = 0.5  # s
GATHER = 0.1  # s from the first entry to its writing: ten calls during a hand-over make it half as long again
VITAL = {"run", "tree", "stop", "alarm", "warning"}  # kinds of events that a flood of other events must not push out
LARGEST = 16 * 2**20  # bytes of an entry: more is too large for the store and too slow over ROS
# Errors of the store, not of an entry: they pass, or a person repairs the store.
MAY_PASS = {"STORE_DOWN", "STORE_FULL", "STORE_REFUSED", "STORE_NEWER", "STORE_CONFLICT", "DB_FAILED", "BUSY"}

WAITING = Gauge("tms_ts_journal_waiting_bytes", "Journal entries not yet written to the database")
LOST = Counter("tms_ts_journal_lost_total", "Journal entries that could not be kept on disk, or not be stored at all")


class Journal:
    """Delivers entries in order; repeats a batch until the database has it."""

    def __init__(self, ros: Ros, log: Logger, disk: GroupCommit, state: Path) -> None:
        self._ros, self._log, self._disk = ros, log, disk
        self._changed, self._urgent = threading.Event(), threading.Event()
        self._spool = Spool(state / "ts" / "journal", self._changed.set)
        self._closing = threading.Event()
        self._away = False  # the database is away, and that is logged
        self._trouble = ""  # of the disk, as it was last reported
        self._losing = threading.Lock()  # guards the next
        self._unreported: dict[str, tuple[int, int, int]] = {}  # run -> entries lost, and the first and last number
        self._thread = threading.Thread(target=self._write, name="journal", daemon=True)
        self._thread.start()

    def put(self, entry: Run | Event) -> None:
        """Take an entry, without waiting."""
        data = pack(entry)
        if len(data) > LARGEST:
            self._lost(entry, EntryTooLarge(len(data), LARGEST))
            return
        event = "" if isinstance(entry, Run) else entry.kind
        urgent = isinstance(entry, Run) or event == "tree"  # operators watch runs that begin or end
        vital = urgent or event in VITAL
        if self._spool.full():
            self._lost(entry, JournalFull(self._spool.waiting()))
        elif not self._disk.put(self._spool, to_line(type(entry), data), vital=vital, urgent=urgent):
            trouble = self._disk.trouble()
            self._lost(entry, Foreign(trouble) if trouble else DiskFull())
        elif urgent:
            self._disk.after(self._urgent.set)

    def alarms(self) -> list[Reason]:
        """The new problems with the history since the last call."""
        trouble = self._disk.trouble()
        reported, self._trouble = self._trouble, trouble
        found: list[Reason] = [HistoryInMemory(Foreign(trouble))] if trouble and not reported else []
        with self._losing:
            lost, self._unreported = self._unreported, {}
        for run, (count, first, last) in lost.items():
            found.append(HistoryLost(run, count, first, last))
        return found

    def close(self) -> None:
        """Give the last entries a moment to be delivered; the rest waits on the disk for the next process."""
        deadline = monotonic() + 0.5
        while self._spool.waiting() and monotonic() < deadline:
            sleep(0.01)
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
                    self._lost(self._entry(lines[0]), problem.reason)
                    self._spool.done(end)
                most = max(1, len(lines) // 2)  # halve the batch, to find the entry that is refused for good
            self._closing.wait(RETRY)  # also after a refusal: a database that is just ending may refuse any entry
        self._spool.close()

    def _gather(self) -> None:
        """Wait for entries, and a moment longer for those that follow at once."""
        if self._changed.wait(0.2):
            self._changed.clear()
            self._urgent.wait(GATHER)
            self._urgent.clear()

    def _passes(self, problem: DbError | RosError) -> bool:
        """Whether the same entries can be written later; logged once."""
        passes = isinstance(problem, RosError) or problem.code in MAY_PASS
        if passes and not self._away:
            self._log.warning("journal_waits", reason=problem.reason)
        self._away = passes
        return passes

    def _lost(self, entry: Run | Event | None, reason: Reason) -> None:
        LOST.inc()
        run, number = (entry.run_id, getattr(entry, "number", 0)) if entry is not None else ("", 0)
        self._log.error("journal_lost", run=run, number=number, reason=reason)
        with self._losing:
            count, first, _ = self._unreported.get(run, (0, number, number))
            self._unreported[run] = (count + 1, first, number)

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
        if not answer.error_code:
            return None
        return DbError(refusal(answer.error_code, answer.error_msg), answer.error_code)

    def _entry(self, line: bytes) -> Run | Event | None:
        try:
            return of_line(line) if line else None
        except (ValueError, RuntimeError) as error:
            self._log.error("journal_unreadable", reason=str(error))
            return None
