"""The checkpoint of a run on this PC until the run has ended: it serves to close it after a crash, and to resume it.

Each run has a file with one JSON object per line: first the run, then the number of every event and every leaf goal
that was sent or has ended. A run that ended in order leaves no file. Group commit writes the lines, so adding one does
not wait. In each group, checkpoints are on the disk before the journal: each reported event has its number here. Pure.
"""

import json
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

import structlog
from prometheus_client import Counter

from tms_config.clock import unix_time
from tms_decision.leaf.events import Key
from tms_runtime.durable import set_aside
from tms_ts.append_file import AppendFile
from tms_ts.group_commit import GroupCommit
from tms_ts.interrupted_run import Header, InterruptedRun, read

READ_LIMIT = 2.0  # s for waiting lines to be on the disk before a checkpoint is read

log = structlog.stdlib.get_logger(__name__)
LOST = Counter("tms_ts_record_lost_total", "Lines of a run's record that could not be kept; it cannot be resumed")


class RunCheckpoint:
    """The checkpoint of one run, written by it.

    Each line begins with its line break: a line that a crash has cut does not damage the next one.
    """

    order = 0

    def __init__(self, path: Path, disk: GroupCommit) -> None:
        self.path, self._disk = path, disk
        self._file: AppendFile | None = None  # opened with the first line, by the writing thread
        self._ended = False

    def _line(self, data: dict[str, Any], urgent: bool = False) -> None:
        """Write a line; `urgent`: at once, as a resume relies on it (a killed process loses lines that still wait)."""
        if self._ended:
            return  # the run is over
        if not self._disk.put(self, b"\n" + json.dumps({**data, "t": unix_time()}).encode(), vital=True, urgent=urgent):
            LOST.inc()
            log.error("record_lost", file=self.path.name, line=next(iter(data)))

    def begin(self, header: Header) -> None:
        self._line({"run": asdict(header)})

    def event(self, number: int) -> None:
        self._line({"n": number})

    def sent(self, key: Key) -> None:
        self._line({"sent": key}, urgent=True)

    def done(self, key: Key, succeeded: bool) -> None:
        self._line({"done": key, "ok": succeeded}, urgent=True)

    def gone(self, key: Key, left: int) -> None:
        """Note that a later resume must not skip the last `left` ends of that leaf goal: the run has passed them."""
        self._line({"gone": key, "left": left})

    def over(self, outcome: str, reason: str) -> None:
        """Note that the run ends; the next event reports it."""
        self._line({"over": outcome, "reason": reason})

    def interrupted(self) -> None:
        """Note that the history has the run as interrupted."""
        self._line({"interrupted": True})

    def close(self) -> None:
        """Refuse further lines; the file stays."""
        self._ended = True
        self._disk.after(self._close)

    def remove(self) -> None:
        """Remove the file of a run that has ended in order, after its end is stored."""
        self._ended = True
        self._disk.after(self._remove)

    # for group commit

    def write(self, entries: list[bytes]) -> None:
        self._file = self._file or AppendFile(self.path)
        self._file.write(b"".join(entries))

    def sync(self) -> None:
        if self._file is not None:
            self._file.sync()

    def keep(self) -> None:
        if self._file is not None:
            self._file.keep()

    def _close(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None

    def _remove(self) -> None:
        self._close()
        self.path.unlink(missing_ok=True)


class Records:
    """All checkpoints of this PC, in `<state>/ts/runs/`."""

    def __init__(self, state: Path, disk: GroupCommit) -> None:
        self._folder, self._disk = state / "ts" / "runs", disk

    def open(self, run_id: str) -> RunCheckpoint:
        """The checkpoint of a run, new or continued."""
        return RunCheckpoint(self._folder / f"{run_id}.jsonl", self._disk)

    def check(self) -> None:
        """Before the first run: set unreadable files aside, log that, and go on with the others."""
        for path in sorted(self._folder.glob("*.jsonl")):
            try:
                past = read(path)
                problem = "" if past.header is not None else "it does not say which run it is of"
            except OSError as error:
                problem = str(error)
            if problem:
                log.error("record_unreadable", kept=set_aside(path), reason=problem)
            elif past.damaged:
                log.error("record_damaged", file=path, lines=past.damaged)

    def past(self) -> list[InterruptedRun]:
        """Runs that did not end in order, oldest first. Waits a moment for lines that are not on the disk yet."""
        self._disk.wait(READ_LIMIT)
        found = []
        for path in sorted(self._folder.glob("*.jsonl")):
            with suppress(OSError):  # `check` has logged it at the start
                found.append(read(path))
        return [past for past in found if past.header is not None]

    def names(self) -> list[str]:
        """The ids of the runs of `past`."""
        return [past.header.run_id for past in self.past() if past.header is not None]

    def find(self, run_id: str) -> InterruptedRun | None:
        """The interrupted run called `run_id`; the beginning of the id is enough when only one fits."""
        hits = [past for past in self.past() if past.header and past.header.run_id.startswith(run_id)]
        return hits[0] if len(hits) == 1 and run_id else None
