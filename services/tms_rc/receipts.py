"""The last receipts of a machine, on the disk before they are reported, and sent again after a restart. Pure logic."""

import base64
import os
from collections import deque
from pathlib import Path

from tms_runtime import durable

KEPT = 20  # as many as the topic keeps for late comers
ROOM = 200  # lines after which the file is written anew


class Receipts:
    """One line a receipt in `<state>/rc/<machine>.receipts`, each with its serialised message."""

    def __init__(self, folder: Path, machine: str) -> None:
        self._path = folder / "rc" / f"{machine}.receipts"
        self._last = deque(self._read(), maxlen=KEPT)
        self._lines = ROOM  # the first receipt that is kept rewrites the file, without a line that a crash has cut

    def all(self) -> list[bytes]:
        """The last receipts, oldest first."""
        return list(self._last)

    def keep(self, data: bytes) -> None:
        """Write one more receipt to the disk.

        Raises:
            OSError: it could not be written.
        """
        self._last.append(data)
        lines, self._lines = self._lines, ROOM  # after a failure, the next receipt rewrites the file
        if lines >= ROOM:
            durable.replace(self._path, b"".join(map(_line, self._last)))
            self._lines = len(self._last)
            return
        number = os.open(self._path, os.O_WRONLY | os.O_APPEND)
        try:
            durable.write_all(number, _line(data))
            os.fsync(number)
        finally:
            os.close(number)
        self._lines = lines + 1

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
                continue  # a line that a crash has cut, with a whole line after it
        return found


def _line(data: bytes) -> bytes:
    return base64.b64encode(data) + b"\n"
