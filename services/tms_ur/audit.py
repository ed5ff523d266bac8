"""Who did what, from where: every command goes to the log at once and to the `event` collection soon.

The entries are the journal of a run called `audit`, numbered by the second in which they were made (one later if that
number is taken), so that they go on after a restart and can be asked for by time. No command waits for the database.
"""

import logging
import queue
import threading
import time

from prometheus_client import Counter
from tms_msg_db.msg import Event
from tms_msg_db.srv import WriteJournal

from tms_core.errors import RosError
from tms_core.ros import Ros

RUN = "audit"
MOST_WAITING = 1000
RETRY = 1.0  # s
LOST = Counter(
    "tms_ur_audit_lost_total", "Commands that are in the log only: the database was away too long, or could not take it"
)
# What a conversion to ROS raises: a text that is no Unicode (a ValueError), a number that does not fit, a wrong type.
UNSENDABLE = (ValueError, OverflowError, TypeError, AssertionError)
log = logging.getLogger(__name__)


class Audit:
    """Writes in a thread of its own, in order."""

    def __init__(self, ros: Ros) -> None:
        self._ros = ros
        self._last = 0
        self._waiting: queue.Queue[Event] = queue.Queue(MOST_WAITING)
        self._lock = threading.Lock()
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._write, name="audit", daemon=True)
        self._thread.start()

    def put(self, who: str, source: str, what: str, target: str) -> None:
        """Take a note; waits for nobody."""
        log.info("event=command what=%s target=%s who=%s from=%s", what, target, who, source)
        with self._lock:
            self._last = max(self._last + 1, int(time.time()))
            event = Event(run_id=RUN, number=self._last, stamp=self._ros.now(), kind=what, node=target,
                          text=f"{who} from {source}")  # fmt: skip
            try:
                self._waiting.put_nowait(event)
            except queue.Full:
                LOST.inc()

    def close(self) -> None:
        """Give the last entries a moment."""
        self._closing.set()
        self._thread.join(0.5)

    def _write(self) -> None:
        while not (self._closing.is_set() and self._waiting.empty()):
            try:
                event = self._waiting.get(timeout=0.2)
            except queue.Empty:
                continue
            try:
                while not self._written(event):
                    if self._closing.wait(RETRY):
                        return
            except UNSENDABLE as error:  # this one never goes; those behind it must
                LOST.inc()
                log.error("event=audit_lost what=%s number=%d reason=%r", event.kind, event.number, str(error))

    def _written(self, event: Event) -> bool:
        try:
            answer = self._ros.call(WriteJournal, "/tms/db/write_journal", WriteJournal.Request(events=[event]))
        except RosError:
            return False
        return not answer.error_code
