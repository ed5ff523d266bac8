"""What the kernel counts as waiting for a processor."""

import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from conftest import wait_until
from tms_runtime.priority import URGENT, session_first, threads, undisturbed, waited


def test_a_thread_that_shares_its_processor_has_waited_for_it() -> None:
    me, before = threading.get_native_id(), os.sched_getaffinity(0)
    processor = {min(before)}
    busy = "import os, sys\nos.sched_setaffinity(0, {int(sys.argv[1])})\nwhile True: pass"
    child = subprocess.Popen([sys.executable, "-c", busy, str(*processor)])
    try:
        os.sched_setaffinity(0, processor)
        at_first, deadline = waited({me}), time.monotonic() + 30.0
        while waited({me}) < at_first + 0.05:
            assert time.monotonic() < deadline, "the kernel counts nothing"
    finally:
        os.sched_setaffinity(0, before)
        child.kill()
        child.wait()


def test_a_thread_that_is_gone_has_not() -> None:
    thread = threading.Thread(target=lambda: None)
    thread.start()
    thread.join()
    number = thread.native_id
    assert number is not None
    wait_until(lambda: number not in threads(), 10, "the kernel has dropped the thread, too")
    assert waited({number}) == 0.0


def test_a_session_gets_its_share_where_the_system_allows_it() -> None:
    child = subprocess.Popen(["sleep", "60"], start_new_session=True)
    group = Path(f"/proc/{child.pid}/autogroup")
    try:
        session_first(child.pid, 5)
        assert not group.exists() or group.read_text().rstrip().endswith("nice 5")
        session_first(2**22 + 1, 5)  # one that has ended
    finally:
        child.kill()
        child.wait()


def test_who_was_urgent_has_its_own_priority_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A thread of the console that has sent a stop serves the next one."""
    given = list[tuple[int, int]]()
    monkeypatch.setattr(os, "sched_getscheduler", lambda _pid: os.SCHED_RR)
    monkeypatch.setattr(os, "sched_getparam", lambda _pid: os.sched_param(1))
    note = lambda _pid, policy, param: given.append((policy, param.sched_priority))  # noqa: E731
    monkeypatch.setattr(os, "sched_setscheduler", note)
    with undisturbed(URGENT):
        assert given == [(os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, URGENT)]
    assert given[1:] == [(os.SCHED_RR, 1)]
