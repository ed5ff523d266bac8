"""Finished cycles that the database does not have yet: kept in the file of the ground, and sent from there.

A cycle is sent only when the file that holds it, and the recogniser's state after it, is on the disk. So after a crash
each cycle has the same number as before, and the database, which knows cycles by run, machine and number, counts none
twice.
"""

import threading
from collections import deque
from collections.abc import Iterable
from itertools import islice

from prometheus_client import Counter, Gauge
from pydantic import TypeAdapter

from tms_work.cycle import Cycle

CYCLES = TypeAdapter(list[Cycle])
MOST = 10_000  # cycles that wait: two days of five machines that work without a break; 6 MB on the disk

WAITING = Gauge("tms_ground_cycles_waiting", "Finished cycles that the database does not have yet")
LOST = Counter(
    "tms_ground_cycles_lost_total", "Finished cycles that the database never got: too many waited, or refused"
)


class Waiting:
    """The queue; oldest first. Any thread may use it."""

    def __init__(self, most: int = MOST) -> None:
        self._most = most
        self._lock = threading.Lock()
        self._cycles = deque[str]()  # as JSON
        self._untold = 0  # of those that had to make room
        self._made = self._kept = self._gone = 0  # cycles since the start: made, on the disk, and not here any more

    def put(self, cycles: Iterable[Cycle]) -> None:
        """Take finished cycles; the oldest make room for them, if too many wait."""
        with self._lock:
            for one in cycles:
                self._cycles.append(one.model_dump_json(exclude_defaults=True))
                self._made += 1
            while len(self._cycles) > self._most:
                self._cycles.popleft()
                self._gone += 1
                self._untold += 1
                LOST.inc()
            self._measure()

    def lost(self) -> int:
        """How many had to make room since the last call."""
        with self._lock:
            untold, self._untold = self._untold, 0
        return untold

    @property
    def unkept(self) -> bool:
        """Whether cycles wait for the disk."""
        with self._lock:
            return max(self._kept, self._gone) < self._made

    @property
    def made(self) -> int:
        """How many were made since the start: the argument for `kept` once the present state is on the disk."""
        with self._lock:
            return self._made

    def state(self) -> str:
        """All of them as JSON."""
        with self._lock:
            return f"[{','.join(self._cycles)}]"

    def restore(self, state: str) -> None:
        """Begin with those of a file.

        Raises:
            ValueError: they are none; then nothing has changed.
        """
        found = [one.model_dump_json(exclude_defaults=True) for one in CYCLES.validate_json(state)]
        with self._lock:
            self._cycles.extend(found)
            self._made = self._kept = len(found)
            self._measure()

    def kept(self, number: int) -> None:
        """Note that the disk has a state."""
        with self._lock:
            self._kept = max(self._kept, number)

    def batch(self, most: int) -> list[str]:
        """The oldest cycles that are on the disk, as JSON."""
        with self._lock:
            return list(islice(self._cycles, min(most, max(0, self._kept - self._gone))))

    def done(self, cycles: Iterable[str]) -> None:
        """Let go of cycles that `batch` has given."""
        with self._lock:
            for one in cycles:
                if self._cycles and self._cycles[0] == one:  # it may have made room meanwhile
                    self._cycles.popleft()
                    self._gone += 1
            self._measure()

    def _measure(self) -> None:
        WAITING.set(len(self._cycles))
