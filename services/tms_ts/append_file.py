"""A file of lines that only grows: it holds each group of lines as a whole, or the group is written again."""

import os
from pathlib import Path

from tms_runtime.durable import make_folder, sync_folder, write_all


class AppendFile:
    """Used by one writing thread. The rest of a failed group is cut off before the next group is written."""

    def __init__(self, path: Path) -> None:
        """Opens or makes the file; both may wait for the disk."""
        make_folder(path.parent)
        self._path, self._new = path, not path.exists()
        self.file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o600)
        self.size = os.fstat(self.file).st_size  # bytes of whole groups
        self._written = 0  # bytes of the group that is being written
        self.busy = False  # whether the file may hold more than `size` bytes

    def write(self, data: bytes) -> None:
        """Write a group of lines into the page cache.

        Raises:
            OSError: the disk is full or fails.
        """
        if self.busy:
            os.ftruncate(self.file, self.size)
        self.busy, self._written = True, len(data)
        write_all(self.file, data)

    def sync(self) -> None:
        """Wait until the group is on the disk.

        Raises:
            OSError: the disk fails; the system drops what it could not write, so the group must be written again.
        """
        os.fdatasync(self.file)
        if self._new:
            sync_folder(self._path.parent)
            self._new = False

    def keep(self) -> None:
        """Count the group as part of the file."""
        self.size += self._written
        self.busy, self._written = False, 0

    def close(self) -> None:
        """Close the file."""
        os.close(self.file)
