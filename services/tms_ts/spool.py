"""A queue of lines in a file: what is stored survives a power cut, too, and is taken in order. Pure logic."""

import os
import threading
from collections.abc import Callable
from contextlib import ExitStack, suppress
from pathlib import Path

from tms_ts.append_file import AppendFile

LARGEST = 256 * 2**20  # bytes; some days of a database that is away
PIECE = 2**20  # bytes of one batch, if no line is longer
OLD = 16 * 2**20  # bytes that are done before a queue that never gets empty is moved


class Spool:
    """Lines come by group commit and are taken by one thread; a line is forgotten only when it is said to be `done`."""

    order = 1  # what is taken from here is reported: the records of the same group come first

    def __init__(self, path: Path, stored: Callable[[], None], largest: int = LARGEST) -> None:
        """`stored` is called when there are new lines to take."""
        self._path, self._stored, self._largest = path, stored, largest
        self._lock = threading.Lock()  # over the file while it is written or made smaller
        self._file = AppendFile(path)
        self._taken = 0  # bytes that are done
        # Whether the last line was cut short, by a crash: the reader skips it once it is ended.
        size = self._file.size
        self._cut = size > 0 and os.pread(self._file.file, 1, size - 1) != b"\n"

    # for group commit

    def write(self, entries: list[bytes]) -> None:
        """Lines (without line breaks) into the page cache."""
        with self._lock:
            self._file.write((b"\n" if self._cut else b"") + b"".join(line + b"\n" for line in entries))

    def sync(self) -> None:
        """Wait until they are on the disk."""
        self._file.sync()

    def keep(self) -> None:
        """From now on they can be taken."""
        with self._lock:
            self._file.keep()
            self._cut = False
        self._stored()

    # for the reader

    def full(self) -> bool:
        """Whether the file has reached its bound."""
        return self._file.size > self._largest

    def waiting(self) -> int:
        """Bytes that were not taken yet."""
        return self._file.size - self._taken

    def batch(self, most: int) -> tuple[list[bytes], int]:
        """The next stored lines, and what to give to `done` once they are delivered."""
        limit = PIECE
        data = self._read(limit)
        while len(data) == limit and b"\n" not in data:  # a line that is longer: it comes alone
            limit, most = 2 * limit, 1
            data = self._read(limit)
        lines = data.split(b"\n")[:-1][:most]
        return lines, self._taken + sum(len(line) + 1 for line in lines)

    def done(self, end: int) -> None:
        """Forget everything up to `end`; an empty queue is an empty file."""
        with self._lock:
            self._taken = end
            if self._file.busy:
                return  # more lines are coming, and then this again
            if self.waiting() <= 0:
                self._empty()
            elif self._taken > OLD and self.waiting() <= PIECE:
                self._move()

    def close(self) -> None:
        """Free the file; what is left waits for the next process."""
        self._file.close()

    def _read(self, limit: int) -> bytes:
        return os.pread(self._file.file, min(limit, self.waiting()), self._taken)

    def _empty(self) -> None:
        with suppress(OSError):  # a disk that fails or is read-only: the next process takes the lines once more
            os.ftruncate(self._file.file, 0)
            self._file.size = self._taken = 0

    def _move(self) -> None:
        """Into a new file what waits still; a crash or a power cut leaves the old file or the new one."""
        new = self._path.with_suffix(".new")
        with suppress(OSError), ExitStack() as undo:  # a full disk, most likely: the old file goes on
            new.unlink(missing_ok=True)
            file = AppendFile(new)
            undo.callback(file.close)
            file.write(self._read(self.waiting()))
            os.fsync(file.file)
            new.replace(self._path)  # its name is on the disk with the next group; until then the old file has it all
            undo.pop_all()
            file.keep()
            self._file.close()
            self._file, self._taken = file, 0
