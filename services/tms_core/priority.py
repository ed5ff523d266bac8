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


def others() -> set[int]:
    """All threads but the one that asks."""
    return threads() - {threading.get_native_id()}
