"""Acts of persons that gateways and tms:db tell of go into the audit, each once, whoever was away when it was done.

`<state>/audit.acts` holds which were noted. A crash between the entry and this file may give an act a second entry;
none is lost while its gateway tells of it.
"""

import json
import queue
from pathlib import Path
from typing import TYPE_CHECKING

import structlog
from tms_msg_db.msg import Event

from tms_ros.node import Ros
from tms_runtime import durable

if TYPE_CHECKING:
    from tms_ur.audit import Audit

DEPTH = 20  # acts that a gateway still tells of
REMEMBERED = 100  # acts of one machine that are known to be noted: more than its gateway tells of
KEPT_LIMIT = 30.0  # s that the disk may take
KINDS = ("enable_areas", "escape", "revoke_place")
KEEPER = "tms:db"  # of shared places
log = structlog.stdlib.get_logger(__name__)

Stamp = tuple[int, int]  # s, ns


class Acts:
    """Hears on the executor thread, and notes in a thread of its own, which waits for the disk."""

    def __init__(self, ros: Ros, audit: "Audit", file: Path, machines: list[str]) -> None:
        self._audit, self._file = audit, file
        self._noted = _read(file)
        self._new: queue.SimpleQueue[tuple[str, Event]] = queue.SimpleQueue()
        for machine in machines:
            self._listen(ros, machine, f"/{machine}/rc/acts")
        self._listen(ros, KEEPER, "/tms/places/acts")
        ros.begin(self._work, "acts")

    def _listen(self, ros: Ros, source: str, topic: str) -> None:
        ros.subscribe(Event, topic, lambda act: self._new.put((source, act)), depth=DEPTH, latched=True)

    def _work(self) -> None:
        while True:
            self.note(*self._new.get())

    def note(self, source: str, act: Event) -> None:
        """Note an act of a known kind, unless that was done before; in a thread that may wait."""
        known, stamp = self._noted.setdefault(source, []), (act.stamp.sec, act.stamp.nanosec)
        if act.kind not in KINDS or stamp in known:
            return
        where = source if source == KEEPER else f"{source}:rc"
        if not self._audit.put(act.text, where, act.kind, act.node).wait(KEPT_LIMIT):
            log.warning("audit_late", what=act.kind, reason="it is in the log, and noted when it is told again")
            return
        known.append(stamp)
        del known[:-REMEMBERED]
        try:
            durable.replace(self._file, json.dumps(self._noted).encode())
        except OSError as error:
            log.error("audit_disk_failed", file=self._file, reason=str(error))


def _read(file: Path) -> dict[str, list[Stamp]]:
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
        return {str(name): [(int(s), int(ns)) for s, ns in stamps] for name, stamps in found.items()}
    except FileNotFoundError:
        return {}
    except (OSError, ValueError, TypeError, AttributeError) as error:  # acts that are told again get another entry
        log.error("audit_file_unreadable", file=file, reason=str(error))
        return {}
