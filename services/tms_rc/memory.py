"""Keeps the latch over a restart of the gateway: a file on this PC, written after the stop was commanded."""

import json
import threading
from collections.abc import Callable
from pathlib import Path


class Memory:
    """The cause of the latch in `<state>/rc/<machine>.json`."""

    def __init__(self, folder: Path, machine: str) -> None:
        self._path = folder / "rc" / f"{machine}.json"
        self._writing = threading.Lock()

    def read(self) -> str:
        """The cause that was kept; a file that cannot be read latches, since nobody knows what it said."""
        try:
            cause = json.loads(self._path.read_text(encoding="utf-8"))["latched"]
        except FileNotFoundError:
            return ""
        except (OSError, ValueError, KeyError, TypeError):
            return f"the note of the last stop cannot be read ({self._path})"
        return str(cause)

    def write(self, cause: Callable[[], str]) -> None:
        """Keep what `cause` returns now, empty for armed; several stops may end at once, and the last word counts."""
        self._path.parent.mkdir(parents=True, exist_ok=True)
        part = self._path.with_suffix(".part")
        with self._writing:
            part.write_text(json.dumps({"latched": cause()}), encoding="utf-8")
            part.replace(self._path)
