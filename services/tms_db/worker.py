"""The thread of one part of tms:db: it does a step, waits, and does the next."""

import math
import threading
from collections.abc import Callable

from tms_config.clock import monotonic


class Worker:
    """Calls `step` again and again, each time after as many seconds as the step before has returned.

    `step` may return math.inf: the next step then runs when `wake` is called. It handles its errors itself; an error
    that it raises ends the thread.
    """

    def __init__(self, name: str, step: Callable[[], float], first: float = 0.0, finish: bool = False) -> None:
        """`first`: seconds before the first step; `finish`: one more step runs at the end, for waiting work."""
        self._step, self._first, self._finish = step, first, finish
        self._changed = threading.Condition()
        self._due = math.inf  # monotonic [s]
        self._stopping = False
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)

    @property
    def stopping(self) -> bool:
        """Whether the present step is the last; a long step checks this."""
        return self._stopping

    def start(self) -> None:
        """Begin; returns at once."""
        self.wake(self._first)
        self._thread.start()

    def stop(self, limit: float = 0.0) -> None:
        """End after the present step, and wait for that up to `limit` [s]."""
        with self._changed:
            self._stopping = True
            self._changed.notify_all()
        if limit and self._thread.is_alive():
            self._thread.join(limit)

    def wake(self, within: float = 0.0) -> None:
        """Have the next step run within this many seconds, if it is not due earlier."""
        with self._changed:
            self._due = min(self._due, monotonic() + within)
            self._changed.notify_all()

    def _run(self) -> None:
        while self._wait():
            pause = self._step()
            self.wake(pause)
        if self._finish:
            self._step()

    def _wait(self) -> bool:
        """Wait until a step is due; returns False at the end."""
        with self._changed:
            while not self._stopping and (left := self._due - monotonic()) > 0:
                self._changed.wait(left if left < threading.TIMEOUT_MAX else None)
            self._due = math.inf
            return not self._stopping
