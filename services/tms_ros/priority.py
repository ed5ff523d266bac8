"""Which threads get a processor first on a busy PC. Needs CAP_SYS_NICE; without it nothing changes."""

import os
import threading
from contextlib import suppress
from pathlib import Path


def threads() -> set[int]:
    """Of this process."""
    return {int(thread.name) for thread in Path("/proc/self/task").iterdir()}


def come_first(nice: int, numbers: set[int]) -> None:
    """Give these threads a share of the processors: -20 is the largest, 0 is usual. Those they start inherit it."""
    for number in numbers:
        with suppress(ProcessLookupError, PermissionError):  # it has ended; or without the right to
            os.setpriority(os.PRIO_PROCESS, number, nice)


def session_first(pid: int, nice: int) -> None:
    """Give the login session of a process a share: Linux weighs sessions before it weighs processes (autogroup)."""
    with suppress(OSError):  # without the right to; or no such thing here
        Path(f"/proc/{pid}/autogroup").write_text(str(nice), encoding="ascii")


def waited(numbers: set[int]) -> float:
    """How long these threads have waited for a processor since they began [s]; 0.0 where the kernel does not count."""
    found = 0.0
    for number in numbers:
        with suppress(OSError):  # it has ended; or a kernel without this count
            found += int(Path(f"/proc/self/task/{number}/schedstat").read_text("ascii").split()[1]) * 1e-9
    return found


def others() -> set[int]:
    """All threads but the one that asks."""
    return threads() - {threading.get_native_id()}
