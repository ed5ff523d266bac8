"""The thread that asserts leases: what counts as late, and what it does when the executor stands still."""

import threading
import time

import pytest

from conftest import wait_until
from tms_core.pulse import BEAT, LATE, REMEMBERED, STOOD_STILL, STUCK, Lateness, Pulse, Step


def test_a_late_beat_is_remembered_for_a_while() -> None:
    one = Lateness()
    one.beat(10.0)
    one.beat(10.0 + BEAT)
    assert not one.late(10.0 + BEAT)
    one.beat(10.5)
    assert one.late(10.5) and one.late(10.5 + REMEMBERED / 2)
    for step in range(1, 40):
        one.beat(10.5 + step * BEAT)
    assert not one.late(10.5 + 39 * BEAT)


def test_an_overdue_beat_is_late_and_a_pause_is_not() -> None:
    one = Lateness()
    one.beat(10.0)
    assert one.late(10.0 + BEAT + LATE + 0.01)
    one.pause()
    one.beat(99.0)
    assert not one.late(99.0)


def test_it_says_how_late_a_beat_was() -> None:
    one = Lateness()
    assert one.beat(10.0) == 0.0
    assert one.beat(10.0 + BEAT) == pytest.approx(0.0, abs=1e-6)
    assert one.beat(11.0) == pytest.approx(1.0 - 2 * BEAT)
    one.pause()
    assert one.beat(99.0) == 0.0


def begin(work: Step, name: str) -> threading.Thread:
    thread = threading.Thread(target=work, name=name, daemon=True)
    thread.start()
    return thread


@pytest.fixture
def executor() -> list[Step]:
    return []


def test_it_beats_while_there_are_steps_and_asks_the_executor_once_at_a_time(executor: list[Step]) -> None:
    pulse, beaten = Pulse(threading.current_thread(), executor.append, lambda: None, begin), threading.Semaphore(0)
    pulse.add(beaten.release)
    try:
        assert all(beaten.acquire(timeout=30) for _ in range(6))
        wait_until(lambda: bool(executor), 30, "the executor is asked")
        wait_until(lambda: not pulse.works(), 30, "an executor that does not answer does not work")
        assert len(executor) == 1
        executor.pop()()
        wait_until(pulse.works, 30, "it has answered")
        pulse.remove(beaten.release)
    finally:
        pulse.close()


def test_an_executor_in_a_long_callback_does_not_work() -> None:
    since: list[float | None] = [None]
    pulse = Pulse(threading.current_thread(), lambda step: step(), lambda: since[0], begin)
    try:
        assert pulse.works()
        since[0] = time.monotonic() - 2 * STUCK
        assert not pulse.works()
        since[0] = time.monotonic() + 60.0  # in a short one, however slow this PC is
        assert pulse.works()
    finally:
        pulse.close()


def test_a_step_that_stood_still_is_told() -> None:
    pulse, told = Pulse(threading.current_thread(), lambda step: step(), lambda: None, begin), [(0.0, 0.0)]
    pulse.stood_still = lambda silent, waited: told.append((silent, waited))
    once = iter([STOOD_STILL + 0.2])
    pulse.add(lambda: threading.Event().wait(next(once, 0.0)) and None)
    try:
        wait_until(lambda: len(told) > 1, 30, "it is told")
        silent, for_a_processor = told[1]
        assert silent > STOOD_STILL and 0.0 <= for_a_processor <= silent
    finally:
        pulse.close()


def test_an_executor_that_did_not_answer_for_long_is_told(executor: list[Step]) -> None:
    pulse, told = Pulse(threading.current_thread(), executor.append, lambda: None, begin), [0.0]
    pulse.stood_still = lambda silent, waited: told.append(silent)
    silent_since = [0.0]
    pulse.add(lambda: None)
    try:
        wait_until(lambda: not pulse.works(), 30, "it is asked, and does not answer")
        silent_since.append(time.monotonic())
        wait_until(lambda: time.monotonic() - silent_since[1] > STOOD_STILL, 30, "nothing was asserted for long")
        assert len(told) == 1
        executor.pop()()
        wait_until(lambda: len(told) > 1, 30, "it is told")
        assert told[1] > STOOD_STILL
    finally:
        pulse.close()
