"""A queue of lines in a file: what was put survives the process, and is taken in order. Pure logic."""

import errno
import os
import threading
from pathlib import Path

LARGEST = 256 * 2**20  # bytes; some days of a database that is away
PIECE = 2**20  # bytes of one batch, if no line is longer
OLD = 16 * 2**20  # bytes that are done before a queue that never gets empty is moved


class SpoolFull(OSError):
    """The file has reached its bound."""


class Spool:
    """Lines are put by any thread and taken by one; a line is forgotten only when it is said to be `done`."""

    def __init__(self, path: Path, largest: int = LARGEST) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        self._path = path
        self._lock = threading.Lock()  # held for one write to the page cache
        self._file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o600)
        self._largest = largest
        self._size = os.fstat(self._file).st_size
        self._taken = 0  # bytes that are done
        # Whether the last line was cut short, by a crash or a full disk: the reader skips it once it is ended.
        self._cut = self._size > 0 and os.pread(self._file, 1, self._size - 1) != b"\n"

    def put(self, line: bytes) -> None:
        """Add a line (without line break).

        Raises:
            OSError: the disk is full or the file has reached its bound.
        """
        with self._lock:
            if self._size > self._largest:
                raise SpoolFull(f"{self._size} bytes wait already")
            self._append(line + b"\n")

    def _append(self, data: bytes) -> None:
        data = b"\n" + data if self._cut else data
        written = os.write(self._file, data)
        self._size += written
        self._cut = written < len(data)
        if self._cut:
            raise OSError(errno.ENOSPC, f"only {written} of {len(data)} bytes could be written")

    def waiting(self) -> int:
        """Bytes that were not taken yet."""
        return self._size - self._taken

    def batch(self, most: int) -> tuple[list[bytes], int]:
        """The next lines, and what to give to `done` once they are delivered."""
        limit = PIECE
        data = os.pread(self._file, limit, self._taken)
        while len(data) == limit and b"\n" not in data:  # a line that is longer: it comes alone
            limit, most = 2 * limit, 1
            data = os.pread(self._file, limit, self._taken)
        lines = data.split(b"\n")[:-1][:most]
        return lines, self._taken + sum(len(line) + 1 for line in lines)

    def done(self, end: int) -> None:
        """Forget everything up to `end`; an empty queue is an empty file."""
        with self._lock:
            self._taken = end
            if self._taken >= self._size:
                os.ftruncate(self._file, 0)
                self._taken = self._size = 0
            elif self._taken > OLD and self.waiting() <= PIECE:
                self._move()

    def _move(self) -> None:
        """Into a new file what waits still; a crash leaves the old file or the new one."""
        new = self._path.with_suffix(".new")
        try:
            new.touch(0o600)
            new.write_bytes(os.pread(self._file, self.waiting(), self._taken))
            file = os.open(new, os.O_RDWR | os.O_APPEND)
            new.replace(self._path)
        except OSError:  # a full disk, most likely: the old file goes on
            return
        os.close(self._file)
        self._file = file
        self._size, self._taken = self.waiting(), 0

    def close(self) -> None:
        """Free the file; what is left waits for the next process."""
        os.close(self._file)
