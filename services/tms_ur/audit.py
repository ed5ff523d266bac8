"""Records who gave which command from where: at once in the log, then on the disk of this PC and in the database.

The entries are the journal of a run called `audit`: numbered one by one, each tied to the one before (audit_chain.py).
One thread writes to the disk, another one sends from there to the database. The thread of a request does not wait
here: a stop is sent whether or not its entry is on the disk; for any other command commands.py waits a moment.
"""

import queue
import sqlite3
import threading
from contextlib import suppress
from pathlib import Path
from typing import Any

import structlog
from builtin_interfaces.msg import Time
from prometheus_client import Counter
from tms_msg_db.msg import Event
from tms_msg_db.srv import ListEvents, WriteJournal

from tms_config.clock import unix_ns
from tms_interfaces.generated import Reply, Req, ServiceType
from tms_machine.values import from_parameters, to_parameters
from tms_reason import wire
from tms_reason.errors import TmsError
from tms_ros.node import Ros
from tms_ur.audit_chain import RUN, AuditEntry, ChainHead, Note, entry, highest, tied
from tms_ur.audit_ledger import Ledger, LedgerFull, opened
from tms_ur.strangers import Strangers

MAX_NEW = 1000  # notes that may wait for the disk
BATCH = 100  # notes in one request to the database; a crash may leave a part of them stored
STRANGERS_PERIOD = 1.0  # s between checks for refusals to report
RETRY = 1.0  # s
LONGEST = 600  # characters of a text; the rest is cut
LOST = Counter("tms_ur_audit_lost_total", "Commands that are in the log only: the disk failed or was full")
log = structlog.stdlib.get_logger(__name__)


class Audit:
    """Has two threads: one writes to the disk, the other sends from there to the database."""

    def __init__(self, ros: Ros, file: Path) -> None:
        self._ros, self._file = ros, file
        self._strangers = Strangers()
        self._new: queue.Queue[tuple[Note, threading.Event] | None] = queue.Queue(MAX_NEW)
        self._ledger: Ledger | None = None
        self._number = 0
        self._changed, self._closing = threading.Event(), threading.Event()
        self._keeper = threading.Thread(target=self._keep, name="audit_disk", daemon=True)
        self._sender = threading.Thread(target=self._send, name="audit", daemon=True)
        self._keeper.start()
        self._sender.start()

    def put(self, who: str, source: str, what: str, target: str, times: int = 1) -> threading.Event:
        """Take a note without waiting. The returned event is set when the note is on the disk."""
        log.info("command", what=what, target=target, who=who, source=source, times=times)
        kept = threading.Event()
        note = Note(unix_ns() // 1_000_000, what, _clean(target), _clean(f"{who} from {source}"), times)
        try:
            self._new.put_nowait((note, kept))
        except queue.Full:
            LOST.inc()
        return kept

    def refused(self, who: str, source: str, what: str, why: str) -> None:
        """Take a note of a refused request; those of a minute become one entry."""
        if self._strangers.add(who, source, what, why):
            self.put(who, source, what, why)

    def number(self) -> int:
        """Number of the last entry in the database; 0 until it is known."""
        return self._number

    def close(self) -> None:
        """Write the last notes to the disk; notes that the database does not have yet are sent after the next start."""
        for refused in self._strangers.due(everything=True):
            self.put(refused.who, refused.source, refused.what, refused.why, refused.times)
        self._closing.set()
        self._changed.set()
        with suppress(queue.Full):  # a full queue wakes the thread as well
            self._new.put_nowait(None)
        self._keeper.join(0.5)
        self._sender.join(0.2)

    # to the disk

    def _keep(self) -> None:
        while self._ledger is None:
            self._open()
            if self._ledger is None and self._closing.wait(RETRY):
                return
        self._changed.set()
        while not (self._closing.is_set() and self._new.empty()):
            for refused in self._strangers.due():
                self.put(refused.who, refused.source, refused.what, refused.why, refused.times)
            found = self._gather()
            while found and not self._kept(self._ledger, found):
                if self._closing.wait(RETRY):
                    return

    def _open(self) -> None:
        try:
            self._ledger, new = opened(self._file)
        except (sqlite3.Error, OSError) as error:
            log.error("audit_disk_failed", file=self._file, reason=str(error))
            return
        if new:
            log.error("audit_file_unreadable", file=self._file, reason="what waited there is in the log only")

    def _gather(self) -> list[tuple[Note, threading.Event]]:
        found: list[tuple[Note, threading.Event]] = []
        try:
            while len(found) < MAX_NEW:
                one = self._new.get(timeout=STRANGERS_PERIOD) if not found else self._new.get_nowait()
                if one is None:
                    break
                found.append(one)
        except queue.Empty:
            pass
        return found

    def _kept(self, ledger: Ledger, found: list[tuple[Note, threading.Event]]) -> bool:
        try:
            ledger.append([note for note, _ in found])
        except LedgerFull:
            LOST.inc(len(found))
            log.error("audit_lost", entries=len(found), reason="too many wait for the database")
            return True
        except (sqlite3.Error, OSError) as error:
            log.error("audit_disk_failed", file=self._file, reason=str(error))
            return False
        for _, kept in found:
            kept.set()
        self._changed.set()
        return True

    # to the database

    def _send(self) -> None:
        self._changed.wait()
        placed = False
        while not self._closing.is_set():
            try:
                assert self._ledger is not None  # the first event is set after it was opened
                if not placed:
                    self._take_place(self._ledger)
                    placed = True
                self._changed.clear()
                while self._sent(self._ledger) and not self._closing.is_set():
                    pass
                self._changed.wait()
            except TmsError:  # the database is away, which other processes report
                self._closing.wait(RETRY)
            except (sqlite3.Error, OSError) as error:
                log.error("audit_disk_failed", file=self._file, reason=str(error))
                self._closing.wait(RETRY)

    def _take_place(self, ledger: Ledger) -> None:
        """Find where the chain goes on: after the place on the disk, or after later entries in the database."""
        place = ledger.place()
        if place is not None:
            self._number = place.number
            stored = self._stored(place.number, BATCH)
            ours = tied(place, ledger.waiting(BATCH)[1])[: len(stored)]
            if [one.hash for one in ours] == [one.hash for one in stored]:
                return  # entries that the database has already are sent again, which changes nothing
            log.error("audit_place_lost", number=place.number, reason="the database has others behind it")
        number = highest(lambda after: bool(self._stored(after, 1)))
        last = self._stored(number - 1, 1) if number else []
        self._number = number
        ledger.move(ChainHead(number, last[0].hash if last else ""))

    def _sent(self, ledger: Ledger) -> bool:
        """Send the oldest notes; returns whether there were any."""
        place = ledger.place()
        assert place is not None
        ids, notes = ledger.waiting(BATCH)
        if not notes:
            return False
        entries = tied(place, notes)
        self._ask(WriteJournal, "/tms/db/write_journal", events=list(map(_event, entries)))
        self._number = entries[-1].number
        ledger.move(ChainHead(self._number, entries[-1].hash), ids[-1])
        return True

    def _stored(self, after: int, limit: int) -> list[AuditEntry]:
        try:
            found = self._ask(ListEvents, "/tms/db/list_events", run_id=RUN, after=after, limit=limit)
        except TmsError as error:
            if error.code != "RUN_MISSING":
                raise
            return []
        return list(map(of_event, found.events))

    def _ask(self, service_type: ServiceType[Req, Reply], name: str, **fields: Any) -> Reply:
        request_type: Any = service_type.Request
        request: Req = request_type(**fields)
        answer = self._ros.call(service_type, name, request)
        if answer.error_code:
            raise TmsError(wire.refusal(answer.error_code, answer.error_msg), answer.error_code)
        return answer


def _event(one: AuditEntry) -> Event:
    seconds, rest = divmod(one.note.at, 1000)
    stamp = Time(sec=seconds, nanosec=rest * 1_000_000)
    return Event(run_id=RUN, number=one.number, stamp=stamp, kind=one.note.kind, node=one.note.node,
                 text=one.note.text, values=to_parameters(one.values()))  # fmt: skip


def of_event(event: Event) -> AuditEntry:
    """An entry from its message."""
    at = event.stamp.sec * 1000 + event.stamp.nanosec // 1_000_000
    return entry(event.number, Note(at, event.kind, event.node, event.text), from_parameters(event.values))


def _clean(text: str) -> str:
    """A text that passes ROS and the database unchanged: valid Unicode without NUL, and not too long."""
    return text.encode(errors="replace").decode().replace("\0", "�")[:LONGEST]
