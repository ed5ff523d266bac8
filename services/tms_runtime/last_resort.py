"""An end for a process whose clean-up hangs in native code.

Fast DDS 2.14 hangs once in some hundred departures while other processes come and go: to destroy a participant, it
waits for a discovery callback that is under way, with a deadline that overflows, and keeps the lock that the callback
needs. rclpy holds the interpreter meanwhile, so no thread, timer or signal handler of Python runs again. A thread of
the C library can still end the process.
"""

import ctypes
import os
import time

LEAVE_LIMIT = 1.0  # s to leave the ROS graph; without its goodbye, other processes drop this one after some seconds
SIGEV_THREAD = 2  # of <signal.h>: the timer calls a function in a thread of its own


class _Event(ctypes.Structure):
    """`struct sigevent`: 64 bytes."""

    _fields_ = (
        ("value", ctypes.c_void_p),
        ("signal", ctypes.c_int),
        ("notify", ctypes.c_int),
        ("function", ctypes.c_void_p),
        ("attributes", ctypes.c_void_p),
        ("rest", ctypes.c_char * 32),
    )


class _Time(ctypes.Structure):
    """`struct itimerspec`; without an interval, the timer expires once."""

    _fields_ = tuple((name, ctypes.c_long) for name in ("interval_s", "interval_ns", "seconds", "nanoseconds"))


def end_after(seconds: float, code: int) -> None:
    """End this process with an exit code after `seconds` (more than 0), unless it has ended by itself.

    Raises:
        OSError: the system has no timer left.
    """
    library = ctypes.CDLL(None, use_errno=True)
    event = _Event(value=code, notify=SIGEV_THREAD, function=ctypes.cast(library._exit, ctypes.c_void_p))
    timer = ctypes.c_void_p()
    when = _Time(seconds=int(seconds), nanoseconds=int(seconds % 1 * 1e9))
    if library.timer_create(time.CLOCK_MONOTONIC, ctypes.byref(event), ctypes.byref(timer)) or library.timer_settime(
        timer, 0, ctypes.byref(when), None
    ):
        raise OSError(ctypes.get_errno(), f"no timer: {os.strerror(ctypes.get_errno())}")
