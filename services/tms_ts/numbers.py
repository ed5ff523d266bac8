"""Fencing numbers of runs: always growing, also over restarts and when the clock goes back."""

import threading
import time
from pathlib import Path


class Numbers:
    """Milliseconds since 1970, or one more than the last number kept in `<state>/ts/number`."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / "ts" / "number"
        self._giving = threading.Lock()  # two runs that start at once must not get one number

    def next(self) -> int:
        """A number for a new run; fits into 48 bits until the year 10889. From any thread."""
        with self._giving:
            return self._next()

    def _next(self) -> int:
        try:
            last = int(self._path.read_text(encoding="ascii"))
        except (FileNotFoundError, ValueError):
            last = 0
        number = max(last + 1, time.time_ns() // 1_000_000)
        self._path.parent.mkdir(parents=True, exist_ok=True)
        part = self._path.with_suffix(".part")
        part.write_text(str(number), encoding="ascii")
        part.replace(self._path)
        return number
