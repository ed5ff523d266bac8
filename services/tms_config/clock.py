"""Time, from one place: a rehearsal can give the whole mesh another one.

Leases of DDS, `fsync` and the kernel have their own.
"""

import time
from datetime import datetime, timezone


def monotonic() -> float:
    """s, for waits, limits and ages; never jumps."""
    return time.monotonic()


def unix_time() -> float:
    """S since 1970, for stamps that other PCs read; jumps when somebody sets the clock."""
    return time.time()


def unix_ns() -> int:
    """`unix_time` in ns, for stamps of messages and fencing numbers."""
    return time.time_ns()


def utc_now() -> datetime:
    """As `unix_time`, for records and people."""
    return datetime.now(timezone.utc)


def sleep(seconds: float) -> None:
    """Let time pass."""
    time.sleep(seconds)
