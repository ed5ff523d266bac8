"""The thread that asserts leases: what counts as late, and what it does when the executor stands still."""

import threading
import time

import pytest

from conftest import wait_until
from tms_runtime.pulse import BEAT, LATE, REMEMBERED, STOOD_STILL, STUCK, Lateness, Pulse, Step


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


class Executor:
    """One that runs what it is asked at once, or keeps it."""

    def __init__(self, keeps: bool = False) -> None:
        self.since: float | None = None
        self.kept: list[Step] | None = [] if keeps else None

    def begin(self, work: Step, name: str) -> threading.Thread:
        thread = threading.Thread(target=work, name=name, daemon=True)
        thread.start()
        return thread

    def on_executor(self, step: Step) -> None:
        if self.kept is None:
            step()
        else:
            self.kept.append(step)

    def busy_since(self) -> float | None:
        return self.since

    def thread_number(self) -> int | None:
        return threading.main_thread().native_id

    def on_stop(self, step: Step) -> None:
        """Each test closes its own."""


def test_it_beats_while_there_are_steps_and_asks_the_executor_once_at_a_time() -> None:
    executor = Executor(keeps=True)
    assert executor.kept is not None
    pulse, beaten = Pulse(executor), threading.Semaphore(0)
    pulse.add(beaten.release)
    try:
        assert all(beaten.acquire(timeout=30) for _ in range(6))
        wait_until(lambda: bool(executor.kept), 30, "the executor is asked")
        wait_until(lambda: not pulse.works(), 30, "an executor that does not answer does not work")
        assert len(executor.kept) == 1
        executor.kept.pop()()
        wait_until(pulse.works, 30, "it has answered")
        pulse.remove(beaten.release)
    finally:
        pulse.close()


def test_an_executor_in_a_long_callback_does_not_work() -> None:
    executor = Executor()
    pulse = Pulse(executor)
    try:
        assert pulse.works()
        executor.since = time.monotonic() - 2 * STUCK
        assert not pulse.works()
        executor.since = time.monotonic() + 60.0  # in a short one, however slow this PC is
        assert pulse.works()
    finally:
        pulse.close()


def test_a_step_that_stood_still_is_told() -> None:
    pulse, reported = Pulse(Executor()), [(0.0, 0.0)]
    pulse.stood_still = lambda silent, waited: reported.append((silent, waited))
    once = iter([STOOD_STILL + 0.2])
    pulse.add(lambda: threading.Event().wait(next(once, 0.0)) and None)
    try:
        wait_until(lambda: len(reported) > 1, 30, "it is told")
        silent, for_a_processor = reported[1]
        assert silent > STOOD_STILL and 0.0 <= for_a_processor <= silent
    finally:
        pulse.close()


def test_an_executor_that_did_not_answer_for_long_is_told() -> None:
    executor = Executor(keeps=True)
    assert executor.kept is not None
    pulse, reported = Pulse(executor), [0.0]
    pulse.stood_still = lambda silent, waited: reported.append(silent)
    pulse.add(lambda: None)
    try:
        wait_until(lambda: not pulse.works(), 30, "it is asked, and does not answer")
        silent_since, before = time.monotonic(), len(reported)  # a busy PC may have stood still before
        wait_until(
            lambda: time.monotonic() - silent_since > STOOD_STILL + 2 * BEAT, 30, "nothing was asserted for long"
        )
        assert len(reported) == before
        executor.kept.pop()()
        wait_until(lambda: len(reported) > before, 30, "it is told")
        assert reported[before] > STOOD_STILL
    finally:
        pulse.close()
