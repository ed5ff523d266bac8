"""What a gateway knows of the time before its start: notes on the disk of this PC. Without a note, it latches.

A machine is armed only while its note says so: the note is synced before the machine counts as armed, and before the
first goal of a run leaves, it names that run. To latch, the note is deleted, which also works on a full disk; at a
press of the stop button the host agent renames it, as this gateway may not live to latch. No function of this module is
called on the executor thread.
"""

import json
import threading
from pathlib import Path
from typing import Any

from tms_decision.gateway.events import Left
from tms_decision.reasons import NoNote, SoftwareStop
from tms_rc.reasons import NoteUnreadable
from tms_reason import texts, wire
from tms_reason.reason import Reason
from tms_runtime import durable
from tms_runtime.state_folder import armed_note


class LatchFile:
    """`<state>/rc/<machine>.armed`, or `.pressed`; and, for people, `.latched` with the cause."""

    def __init__(self, folder: Path, machine: str) -> None:
        self._folder = folder / "rc"
        self._armed = armed_note(folder, machine)
        self._pressed, self._latched = self._armed.with_suffix(".pressed"), self._armed.with_suffix(".latched")
        self._taken = self._folder / f"{machine}.taken"
        self._writing = threading.Lock()

    def read(self) -> Left:
        """How the machine was left. A damaged note, as a power cut leaves it, latches."""
        taken = str((_load(self._taken) or {}).get("taken", ""))
        note = _load(self._armed)
        if note is None and self._pressed.exists():
            return Left(SoftwareStop(), taken=taken, unproven=True)
        if note is None or note.get("armed") is not True:
            cause = self._cause() if note is None and not self._armed.exists() else NoteUnreadable()
            return Left(cause, taken=taken, unproven=self._unproven())
        holder, run = note.get("holder"), note.get("run")
        if not isinstance(holder, str) or not isinstance(run, int):
            return Left(NoteUnreadable(), taken=taken)
        return Left(None, holder, run, taken)

    def _unproven(self) -> bool:
        receipts = self._latched.with_suffix(".receipts")
        if not self._latched.exists():
            return False
        return not receipts.exists() or receipts.stat().st_mtime_ns < self._latched.stat().st_mtime_ns

    def _cause(self) -> Reason:
        cause = (_load(self._latched) or {}).get("cause")
        return wire.known(cause) if isinstance(cause, str) and cause else NoNote()

    def arm(self, holder: str = "", run: int = 0) -> None:
        """Note that the machine is armed, and which run or client may move it, for the next start.

        Raises:
            OSError: it could not be written: the machine must not count as armed.
        """
        with self._writing:
            _write(self._armed, {"armed": True, "holder": holder, "run": run})
            self._pressed.unlink(missing_ok=True)

    def latch(self, cause: Reason) -> None:
        """Note that the machine is latched, for the next start; the cause is kept if the disk has room for it.

        Raises:
            OSError: the note could not be deleted.
        """
        with self._writing:
            for note in (self._armed, self._pressed):
                note.unlink(missing_ok=True)
            if self._folder.exists():
                durable.sync_folder(self._folder)
            try:
                _write(self._latched, {"cause": wire.to_line(cause), "text": texts.text(cause, "en")})
            except OSError:
                self._latched.unlink(missing_ok=True)  # an older cause would be a wrong one

    def take(self, who: str) -> None:
        """Note who drives the machine by hand; empty: no person does.

        Raises:
            OSError: it could not be written.
        """
        with self._writing:
            _write(self._taken, {"taken": who})


def _load(path: Path) -> dict[str, Any] | None:
    """A note, None if it is not there or cannot be read."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) else None


def _write(path: Path, note: dict[str, Any]) -> None:
    """Replace a note as a whole, also if power fails meanwhile; it is on the disk when this returns."""
    durable.replace(path, json.dumps(note).encode())
