"""The last receipts of a machine, on the disk before they are told, and told again after a restart. Pure logic."""

import base64
import os
from collections import deque
from pathlib import Path

KEPT = 20  # as many as the topic keeps for late comers
ROOM = 200  # lines after which the file is written anew


class Receipts:
    """One line a receipt in `<state>/rc/<machine>.receipts`, each with its serialised message."""

    def __init__(self, folder: Path, machine: str) -> None:
        self._path = folder / "rc" / f"{machine}.receipts"
        self._last = deque(self._read(), maxlen=KEPT)
        self._lines = ROOM  # the first one that is kept makes a new file, without what a crash has cut

    def all(self) -> list[bytes]:
        """The last ones, oldest first."""
        return list(self._last)

    def keep(self, data: bytes) -> None:
        """Have one more on the disk.

        Raises:
            OSError: it is not there.
        """
        self._last.append(data)
        self._path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        if self._lines >= ROOM:
            self._renew()
            return
        lines, self._lines = self._lines, ROOM  # where this fails, the next one does not go on behind a cut line
        self._write(self._path, os.O_APPEND, [data])
        self._lines = lines + 1

    def _renew(self) -> None:
        part = self._path.with_suffix(".part")
        self._write(part, os.O_TRUNC, list(self._last))
        part.replace(self._path)
        folder = os.open(self._path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
        self._lines = len(self._last)

    def _write(self, path: Path, mode: int, data: list[bytes]) -> None:
        number = os.open(path, os.O_WRONLY | os.O_CREAT | mode, 0o600)
        with os.fdopen(number, "wb") as file:
            file.write(b"".join(base64.b64encode(one) + b"\n" for one in data))
            file.flush()
            os.fsync(file.fileno())

    def _read(self) -> list[bytes]:
        try:
            lines = self._path.read_bytes().split(b"\n")
        except FileNotFoundError:
            return []
        found = []
        for line in lines[:-1]:  # the last one was cut, or is empty
            try:
                found.append(base64.b64decode(line, validate=True))
            except ValueError:
                continue  # cut by a crash, with a whole one behind it
        return found
