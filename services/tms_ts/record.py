"""What this PC keeps of a run until it has ended: enough to close it after a crash, and to resume it. Pure logic.

One file a run, one JSON object a line: first the run, then every event's number and every leaf goal that was sent
or has ended. A run that ended in order leaves no file.
"""

import errno
import json
import logging
import os
import threading
import time
from collections import defaultdict, deque
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from prometheus_client import Counter

log = logging.getLogger(__name__)
LOST = Counter("tms_ts_record_lost_total", "Lines of a run's record that could not be written; it cannot be resumed")

Key = tuple[str, str, str, str]  # node path, machine, subtask, record


@dataclass(frozen=True)
class Header:
    """The run, as far as it is known before its first tick."""

    run_id: str
    number: int  # fencing number
    task_id: int
    description: str
    machines: list[str]
    xml: str
    started: tuple[int, int]  # s, ns


class Record:
    """Written by the run; each line is one write, so a crash cuts off the last line at most.

    A line begins with its line break: what a crash or a full disk has cut off before it spoils no other line.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        path.parent.mkdir(parents=True, exist_ok=True)
        self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        self._using = threading.Lock()  # over the file: its number may be another file's once it is closed

    def _line(self, data: dict[str, Any]) -> None:
        with self._using:
            if self._file < 0:
                return  # news of a run that is over
            try:
                self._write(b"\n" + json.dumps({**data, "t": time.time()}).encode())
            except OSError as error:  # a full disk must not keep a run from stopping its machines
                LOST.inc()
                log.error("event=record_lost file=%s reason=%r", self.path.name, str(error))

    def _write(self, line: bytes) -> None:
        written = os.write(self._file, line)
        if written < len(line):
            raise OSError(errno.ENOSPC, f"only {written} of {len(line)} bytes could be written")

    def begin(self, header: Header) -> None:
        self._line({"run": asdict(header)})

    def event(self, number: int) -> None:
        self._line({"n": number})

    def sent(self, key: Key) -> None:
        self._line({"sent": key})

    def done(self, key: Key, succeeded: bool) -> None:
        self._line({"done": key, "ok": succeeded})

    def gone(self, key: Key, left: int) -> None:
        """The last `left` ends of that leaf goal belong to the past: they are not skipped by a later resume."""
        self._line({"gone": key, "left": left})

    def interrupted(self) -> None:
        """The history says now that the run was interrupted."""
        self._line({"interrupted": True})

    def close(self) -> None:
        """Nothing more is written; the file stays."""
        with self._using:
            if self._file >= 0:
                os.close(self._file)
                self._file = -1

    def remove(self) -> None:
        """The run has ended in order."""
        self.close()
        self.path.unlink(missing_ok=True)


class Replay:
    """Leaf goals that have ended before: asked for again, in the same order, they are not repeated.

    Flags are read anew, so the tree may go another way than before the interruption. What it has not asked for when
    a goal is really done belongs to the past, and is done again should the tree come there later.
    """

    def __init__(self, ended: list[tuple[Key, bool]]) -> None:
        self.beside: Callable[[str, str], bool] = lambda node, other: False  # whether neither waits for the other
        self._ended: dict[Key, deque[bool]] = defaultdict(deque)
        for key, succeeded in ended:
            self._ended[key].append(succeeded)

    def take(self, key: Key) -> bool | None:
        """How that leaf goal ended, once; None if it has to be done now."""
        found = self._ended.get(key)
        return found.popleft() if found else None

    def moved_on(self, node: str) -> list[tuple[Key, int]]:
        """A goal of that node was really done: only nodes beside it may still have something to skip.

        Returns what is dropped: how often each leaf goal had ended and was not asked for again.
        """
        past = [key for key in list(self._ended) if not self.beside(key[0], node)]
        dropped = [(key, len(self._ended.pop(key, ()))) for key in past]
        return [(key, left) for key, left in dropped if left]


class Past:
    """A record as it is read after a crash."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.header: Header | None = None
        self.last_event = 0
        self.last_time = 0.0  # s since 1970
        self.closed = False
        self.ended: list[tuple[Key, bool]] = []
        self.open: list[Key] = []  # sent, but not ended
        for line in _lines(path):
            self._take(line)

    def _take(self, line: dict[str, Any]) -> None:
        self.last_time = line.get("t", self.last_time)
        if "run" in line:
            self.header = Header(**{**line["run"], "started": tuple(line["run"]["started"])})
            self.closed = False
        elif "n" in line:
            self.last_event = max(self.last_event, line["n"])
        elif "sent" in line:
            key = _key(line["sent"])
            self.open += [key] if key not in self.open else []
        elif "done" in line:
            key = _key(line["done"])
            self.ended.append((key, line["ok"]))
            if key in self.open:
                self.open.remove(key)
        elif "gone" in line:
            self._forget(_key(line["gone"]), line["left"])
        self.closed = self.closed or "interrupted" in line

    def _forget(self, key: Key, left: int) -> None:
        places = [place for place, (ended, _) in enumerate(self.ended) if ended == key]
        for place in places[::-1][:left]:
            del self.ended[place]


def _key(words: list[str]) -> Key:
    node, machine, subtask, record = words
    return node, machine, subtask, record


def _lines(path: Path) -> Iterator[dict[str, Any]]:
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        return  # its run has ended in order just now
    for text in data.split(b"\n"):
        try:
            line = json.loads(text)
        except ValueError:
            continue  # the last line, cut short by the crash
        if isinstance(line, dict):
            yield line


class Records:
    """All records of this PC, in `<state>/ts/runs/`."""

    def __init__(self, state: Path) -> None:
        self._folder = state / "ts" / "runs"

    def open(self, run_id: str) -> Record:
        """The record of a run, new or continued."""
        return Record(self._folder / f"{run_id}.jsonl")

    def past(self) -> list[Past]:
        """Runs that did not end in order, oldest first."""
        found = [Past(path) for path in sorted(self._folder.glob("*.jsonl"))]
        return [past for past in found if past.header is not None]

    def find(self, run_id: str) -> Past | None:
        """The interrupted run called `run_id`; the beginning of the id is enough when only one fits."""
        hits = [past for past in self.past() if past.header and past.header.run_id.startswith(run_id)]
        return hits[0] if len(hits) == 1 and run_id else None
