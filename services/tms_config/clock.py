"""The source of all time, so that a rehearsal can give the whole mesh another clock.

DDS leases, `fsync` and the kernel use clocks of their own.
"""

import time
from datetime import datetime, timezone


def monotonic() -> float:
    """Time [s] for waits, limits and ages; it never jumps."""
    return time.monotonic()


def unix_time() -> float:
    """Seconds since 1970, for stamps that other PCs read; it jumps when the clock is set."""
    return time.time()


def unix_ns() -> int:
    """`unix_time` in ns, for stamps of messages and fencing numbers."""
    return time.time_ns()


def utc_now() -> datetime:
    """`unix_time` as a date, for records and people."""
    return datetime.now(timezone.utc)


def sleep(seconds: float) -> None:
    """Let time pass."""
    time.sleep(seconds)
