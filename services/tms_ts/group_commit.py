"""Group commit: any thread puts entries, one thread writes those that wait and syncs the disk once for all of them.

`put` waits only for a short lock. An entry is *stored* when it is on the disk: it survives a power cut. While the disk
is full, or does not answer, entries wait in memory in their order, up to a bound; beyond the bound they are refused,
and the caller reports the loss. A process that is killed loses the entries that wait here, those of the last moment
(GATHER): none of them was reported as stored.
"""

import threading
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from itertools import islice
from typing import Protocol

from prometheus_client import Gauge

from tms_config.clock import monotonic
from tms_runtime.log import Logger

GATHER = 0.05  # s from the first entry to its writing, so that many share a sync; urgent entries are written at once
RETRY = 0.5  # s between attempts at a disk that is full
GROUP = 2000  # entries of one group
MAX_WAITING = 32 * 2**20  # bytes that may wait ...
SPARE = 4 * 2**20  # bytes, ... of which this share is reserved for vital entries
SLOW = 5.0  # s without an answer of the disk until that is reported

WAITING = Gauge("tms_unstored_bytes", "Entries in memory that are not on the disk yet")


class Sink(Protocol):
    """A file that entries go to; called by the writing thread only."""

    order: int  # order in which the files of one group are synced: files that others rely on come first

    def write(self, entries: list[bytes]) -> None:
        """Write the entries of one group; after an OSError it is called with them again."""

    def sync(self) -> None:
        """Wait until the entries are on the disk; after an OSError they are written again."""

    def keep(self) -> None:
        """Called when the whole group is on the disk."""


Step = Callable[[], None]


@dataclass(frozen=True)
class QueueEntry:
    """Data for a sink, or a step to be done when all entries before it are stored."""

    sink: Sink | None
    data: bytes = b""
    step: Step | None = None
    at: float = field(default_factory=monotonic)


class GroupCommit:
    """The queue and its writing thread; one per process."""

    def __init__(self, log: Logger, most: int = MAX_WAITING) -> None:
        self._log, self._most = log, most
        self._changed = threading.Condition()  # guards the next four; held for moments only
        self._waiting: deque[QueueEntry] = deque()
        self._bytes = 0
        self._put = self._stored = 0  # entries, since the start
        self._some, self._urgent, self._closed = threading.Event(), threading.Event(), threading.Event()
        self._problem = ""  # why the disk takes no entries now
        self._thread = threading.Thread(target=self._run, name="disk", daemon=True)
        self._thread.start()

    def put(self, sink: Sink, data: bytes, *, vital: bool = False, urgent: bool = False) -> bool:
        """Take an entry for a file, without waiting; False when too much waits already, then the entry is lost.

        Args:
            sink: the file.
            data: the entry.
            vital: it may use the room that is reserved for entries that must not be lost.
            urgent: write it at once, without waiting for other entries to share the sync.
        """
        return self._take(QueueEntry(sink, data), self._most if vital else self._most - SPARE, urgent)

    def after(self, step: Step) -> None:
        """Do a step (it may raise OSError) in the writing thread once all entries before it are stored."""
        self._take(QueueEntry(None, step=step), 2 * self._most, False)

    def wait(self, seconds: float) -> bool:
        """Wait until all entries so far are stored; False when they are not within the time."""
        with self._changed:
            end = self._put
            if self._stored < end:
                self._urgent.set()
            self._changed.wait_for(lambda: self._stored >= end or self._closed.is_set(), seconds)
            return self._stored >= end

    def trouble(self) -> str:
        """Why no entries are stored now; empty if they are."""
        with self._changed:
            if self._problem or not self._waiting:
                return self._problem
            since = monotonic() - self._waiting[0].at
        return f"the disk has not answered for {since:.0f} s" if since > SLOW else ""

    def close(self, seconds: float) -> None:
        """Give waiting entries some time to be stored, then end: later entries are refused."""
        self.wait(seconds)
        with self._changed:
            self._closed.set()
            self._changed.notify_all()
        self._some.set()
        self._urgent.set()
        self._thread.join(seconds)

    def _take(self, entry: QueueEntry, room: int, urgent: bool) -> bool:
        with self._changed:
            if self._closed.is_set() or self._bytes + len(entry.data) > room:
                return False
            self._waiting.append(entry)
            self._bytes += len(entry.data)
            self._put += 1
        if not self._some.is_set():
            self._some.set()
        if urgent:
            self._urgent.set()
        return True

    def _run(self) -> None:
        while self._some.wait() and not self._closed.is_set():
            self._urgent.wait(GATHER)
            self._urgent.clear()
            with self._changed:
                group = list(islice(self._waiting, GROUP))
                if not group and not self._closed.is_set():
                    self._some.clear()
            self._store(group)

    def _store(self, group: list[QueueEntry]) -> None:
        while group and not self._closed.is_set():
            WAITING.set(self._bytes)
            try:
                _write(group)
            except OSError as error:
                self._failed(str(error))
                self._closed.wait(RETRY)
            else:
                self._kept(group)
                return

    def _failed(self, problem: str) -> None:
        if problem != self._problem:
            self._log.error("disk_fails", reason=problem, action="entries wait in memory")
        self._problem = problem

    def _kept(self, group: list[QueueEntry]) -> None:
        if self._problem:
            self._log.warning("disk_works_again", waiting=self._bytes)
        self._problem = ""
        for entry in group:
            if entry.step is not None:
                self._do(entry.step)
        with self._changed:
            for _ in group:
                self._bytes -= len(self._waiting.popleft().data)
            self._stored += len(group)
            self._changed.notify_all()
        WAITING.set(self._bytes)

    def _do(self, step: Step) -> None:
        try:
            step()
        except OSError as error:
            self._log.error("disk_fails", reason=str(error))


def _write(group: Iterable[QueueEntry]) -> None:
    parts: dict[Sink, list[bytes]] = {}
    for entry in group:
        if entry.sink is not None:
            parts.setdefault(entry.sink, []).append(entry.data)
    for sink, entries in parts.items():
        sink.write(entries)
    for sink in sorted(parts, key=lambda sink: sink.order):
        sink.sync()
    for sink in parts:
        sink.keep()
