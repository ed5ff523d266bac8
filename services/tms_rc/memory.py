"""Keeps the latch over a restart of the gateway: a file on this PC, written after the stop was commanded."""

import json
from pathlib import Path


class Memory:
    """The cause of the latch in `<state>/rc/<machine>.json`."""

    def __init__(self, folder: Path, machine: str) -> None:
        self._path = folder / "rc" / f"{machine}.json"

    def read(self) -> str:
        """The cause that was kept; a file that cannot be read latches, since nobody knows what it said."""
        try:
            cause = json.loads(self._path.read_text(encoding="utf-8"))["latched"]
        except FileNotFoundError:
            return ""
        except (OSError, ValueError, KeyError, TypeError):
            return f"the note of the last stop cannot be read ({self._path})"
        return str(cause)

    def write(self, cause: str) -> None:
        """Keep a cause; an empty one means armed."""
        self._path.parent.mkdir(parents=True, exist_ok=True)
        part = self._path.with_suffix(".part")
        part.write_text(json.dumps({"latched": cause}), encoding="utf-8")
        part.replace(self._path)
