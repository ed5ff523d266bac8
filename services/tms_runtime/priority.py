"""Which threads get a processor first on a busy PC. Needs CAP_SYS_NICE; without it, these functions do nothing.

Real-time priorities: 1 for a participant that is being made, at least 1 for what works already (`run.FIRST`), URGENT
for a thread while it sends a stop.
"""

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

# Above the gateways: those that have the stop prove that their machines stand, and kept whoever was still sending it to
# the others from both processors (20 gateways: the last one got it after 60 to 700 ms, now after 19).
URGENT = 4


def threads() -> set[int]:
    """The numbers of this process's threads."""
    return {int(thread.name) for thread in Path("/proc/self/task").iterdir()}


def come_first(nice: int, numbers: set[int], realtime: int = 0) -> None:
    """Give these threads a share of the processors: -20 is the largest, 0 is usual. Threads they start inherit it.

    With `realtime` they come before all threads without, or with less; where the system refuses that, `nice` counts.
    """
    for number in numbers:
        with suppress(ProcessLookupError, PermissionError):  # the thread has ended, or this process lacks the right
            os.setpriority(os.PRIO_PROCESS, number, nice)
            if realtime:
                os.sched_setscheduler(number, os.SCHED_RR, os.sched_param(realtime))


def session_first(pid: int, nice: int) -> None:
    """Give the login session of a process a share: Linux weighs sessions before it weighs processes (autogroup)."""
    with suppress(OSError):  # this process lacks the right, or the kernel has no autogroups
        Path(f"/proc/{pid}/autogroup").write_text(str(nice), encoding="ascii")


def waited(numbers: set[int]) -> float:
    """How long these threads have waited for a processor since they began [s]; 0.0 where the kernel does not count."""
    found = 0.0
    for number in numbers:
        with suppress(OSError):  # the thread has ended, or the kernel does not count
            found += int(Path(f"/proc/self/task/{number}/schedstat").read_text("ascii").split()[1]) * 1e-9
    return found


def others() -> set[int]:
    """All threads but the calling one."""
    return threads() - {threading.get_native_id()}


@contextmanager
def undisturbed(realtime: int = 1) -> Iterator[None]:
    """Keep other processes from this thread's processor, where the system allows it (CAP_SYS_NICE or LimitRTPRIO).

    Fast DDS announces a participant a moment before it listens. On a PC with forty processes, all of them wake up to
    answer; if they run before the participant listens, it discovers them only with their next announcement: measured
    2.1 s instead of 0.25 s. This takes 3 ms, in a program that has to load the middleware first 25 ms.

    Threads that are started meanwhile do not come first: they read answers for some hundred milliseconds, and seven
    processes that started at once kept all others on the PC from its two processors for up to 2.8 s.
    """
    before, policy, usual = threads(), os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(realtime))
    except OSError:  # the system does not allow it, or does not have it
        yield
        return
    try:
        yield
    finally:
        os.sched_setscheduler(0, policy, usual)
        come_first(os.getpriority(os.PRIO_PROCESS, 0), threads() - before)  # their share was reset as well
