"""Fencing numbers of runs: they always grow, also over restarts, power cuts, and when the clock goes back."""

import threading
from pathlib import Path

import structlog

from tms_config.clock import unix_ns
from tms_reason.errors import TaskError
from tms_reason.reason import Foreign
from tms_runtime import durable
from tms_ts.group_commit import GroupCommit
from tms_ts.reasons import DiskSlow, NoDisk

DISK_LIMIT = 5.0  # s for a number to be on the disk
log = structlog.stdlib.get_logger(__name__)


class Numbers:
    """Milliseconds since 1970, or one more than the last number kept in `<state>/ts/number`."""

    order = 0

    def __init__(self, folder: Path, disk: GroupCommit) -> None:
        self._path, self._disk = folder / "ts" / "number", disk
        self._giving = threading.Lock()  # two runs that start at once must not get the same number
        self._last = self._read()
        self._text = b""

    def next(self, above: int = 0) -> int:
        """A number for a new run, larger than `above`, on the disk; fits into 48 bits until the year 10889.

        Waits; from any thread.

        A number that was lost in a power cut would be given again, and late goals of one run would count as the
        other's.

        Raises:
            TaskError: NoDisk.
        """
        with self._giving:
            self._last = number = max(self._last + 1, above + 1, unix_ns() // 1_000_000)
            taken = self._disk.put(self, str(number).encode(), vital=True)
        if not taken or not self._disk.wait(DISK_LIMIT):
            raise no_disk(self._disk)
        return number

    def write(self, entries: list[bytes]) -> None:
        """For group commit: keep the last number, which is the largest."""
        self._text = entries[-1]

    def sync(self) -> None:
        """For group commit."""
        durable.replace(self._path, self._text)

    def keep(self) -> None:
        """For group commit."""

    def _read(self) -> int:
        try:
            return int(self._path.read_text(encoding="ascii"))
        except FileNotFoundError:
            return 0
        except (OSError, ValueError) as error:
            aside = durable.set_aside(self._path)
            log.error("number_unreadable", kept=aside, reason=str(error), action="the clock gives the next")
            return 0


def no_disk(disk: GroupCommit) -> TaskError:
    """Why no run may begin."""
    trouble = disk.trouble()
    return TaskError(NoDisk(Foreign(trouble) if trouble else DiskSlow()))
