"""What a busy PC adds to every time that is measured on it."""

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager


class Lateness:
    """How late a thread of this PC was woken at most [s]: what no process on it could do better."""

    def __init__(self) -> None:
        self.most = 0.0
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._look, daemon=True)

    def _look(self) -> None:
        while True:
            before = time.monotonic()
            if self._over.wait(0.01):
                return
            self.most = max(self.most, time.monotonic() - before - 0.01)

    @contextmanager
    def watched(self) -> Iterator["Lateness"]:
        self._thread.start()
        try:
            yield self
        finally:
            self._over.set()
            self._thread.join()
