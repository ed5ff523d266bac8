"""A queue of lines in a file: stored lines survive a power cut and are taken in order. Pure logic."""

import os
import threading
from collections.abc import Callable
from contextlib import ExitStack, suppress
from pathlib import Path

from tms_ts.append_file import AppendFile

LARGEST = 256 * 2**20  # bytes; enough for some days without the database
PIECE = 2**20  # bytes of one batch, if no line is longer
OLD = 16 * 2**20  # bytes of delivered lines after which a queue that never gets empty is moved to a new file


class Spool:
    """Group commit adds lines and one thread takes them; a line is removed only when the thread calls `done`."""

    order = 1  # lines taken from here are reported, so the checkpoints of the same group are synced first

    def __init__(self, path: Path, stored: Callable[[], None], largest: int = LARGEST) -> None:
        """`stored` is called when there are new lines to take."""
        self._path, self._stored, self._largest = path, stored, largest
        self._lock = threading.Lock()  # guards the file while it is written or made smaller
        self._file = AppendFile(path)
        self._taken = 0  # bytes that are delivered
        # Whether a crash has cut the last line: `write` ends it, and the reader then skips it.
        size = self._file.size
        self._cut = size > 0 and os.pread(self._file.file, 1, size - 1) != b"\n"

    # for group commit

    def write(self, entries: list[bytes]) -> None:
        """Write lines (without line breaks) into the page cache."""
        with self._lock:
            self._file.write((b"\n" if self._cut else b"") + b"".join(line + b"\n" for line in entries))

    def sync(self) -> None:
        """Wait until the lines are on the disk."""
        self._file.sync()

    def keep(self) -> None:
        """Let the reader take the lines from now on."""
        with self._lock:
            self._file.keep()
            self._cut = False
        self._stored()

    # for the reader

    def full(self) -> bool:
        """Whether the file has reached its bound."""
        return self._file.size > self._largest

    def waiting(self) -> int:
        """Bytes that are not delivered yet."""
        return self._file.size - self._taken

    def batch(self, most: int) -> tuple[list[bytes], int]:
        """The next stored lines, and the argument for `done` once they are delivered."""
        limit = PIECE
        data = self._read(limit)
        while len(data) == limit and b"\n" not in data:  # a longer line makes a batch of its own
            limit, most = 2 * limit, 1
            data = self._read(limit)
        lines = data.split(b"\n")[:-1][:most]
        return lines, self._taken + sum(len(line) + 1 for line in lines)

    def done(self, end: int) -> None:
        """Remove all lines up to `end`; the file of an empty queue is empty."""
        with self._lock:
            self._taken = end
            if self._file.busy:
                return  # lines are being written; after them, this is called again
            if self.waiting() <= 0:
                self._empty()
            elif self._taken > OLD and self.waiting() <= PIECE:
                self._move()

    def close(self) -> None:
        """Close the file; the lines left in it wait for the next process."""
        self._file.close()

    def _read(self, limit: int) -> bytes:
        return os.pread(self._file.file, min(limit, self.waiting()), self._taken)

    def _empty(self) -> None:
        with suppress(OSError):  # a disk that fails or is read-only: the next process takes the lines once more
            os.ftruncate(self._file.file, 0)
            self._file.size = self._taken = 0

    def _move(self) -> None:
        """Move the waiting lines into a new file; a crash or a power cut leaves the old file or the new one."""
        new = self._path.with_suffix(".new")
        with suppress(OSError), ExitStack() as undo:  # most likely the disk is full: the old file stays in use
            new.unlink(missing_ok=True)
            file = AppendFile(new)
            undo.callback(file.close)
            file.write(self._read(self.waiting()))
            os.fsync(file.file)
            new.replace(self._path)  # its name is synced with the next group; until then the old file has all lines
            undo.pop_all()
            file.keep()
            self._file.close()
            self._file, self._taken = file, 0
