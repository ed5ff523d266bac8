"""Processor time and memory of a process, from real /proc."""

import os
import time

from tms_host.usage import Usage

NEVER = 2**22 + 1  # above pid_max


def test_a_busy_process_is_seen_to_be_busy() -> None:
    usage = Usage()
    cpu, memory = usage.of(os.getpid())
    assert cpu == 0.0  # nothing to compare with yet
    assert memory > 1_000_000
    until = time.process_time() + 0.1
    while time.process_time() < until:
        pass
    assert usage.of(os.getpid())[0] > 1.0


def test_a_process_that_is_gone() -> None:
    usage = Usage()
    assert usage.of(NEVER) == (0.0, 0)
    usage.of(os.getpid())
    usage.keep(set())
    assert usage.of(os.getpid())[0] == 0.0
