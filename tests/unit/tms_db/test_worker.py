"""The thread of one part of tms:db."""

import math
import threading
from queue import SimpleQueue

import pytest

from tms_db.worker import Worker

LIMIT = 10.0  # s that a step may take to come


class Steps:
    """A step that says when it came, and answers what it is told."""

    def __init__(self, *pauses: float) -> None:
        self.came: SimpleQueue[int] = SimpleQueue()
        self._pauses = list(pauses)
        self._number = 0

    def __call__(self) -> float:
        self._number += 1
        self.came.put(self._number)
        return self._pauses.pop(0) if self._pauses else math.inf


def test_the_next_step_comes_after_the_answered_pause() -> None:
    steps = Steps(0.0, 0.001)
    worker = Worker("test", steps)
    worker.start()
    assert [steps.came.get(timeout=LIMIT) for _ in range(3)] == [1, 2, 3]
    worker.stop(LIMIT)
    assert steps.came.empty()


def test_a_step_comes_when_it_is_asked_for_and_only_then() -> None:
    steps = Steps()
    worker = Worker("test", steps, first=math.inf)
    worker.start()
    worker.wake()
    assert steps.came.get(timeout=LIMIT) == 1
    worker.wake(1000.0)  # a later wish does not put off a nearer one, which comes first here
    worker.wake(0.001)
    assert steps.came.get(timeout=LIMIT) == 2
    worker.stop(LIMIT)
    assert steps.came.empty()


def test_a_wish_during_a_step_is_not_lost() -> None:
    entered, leave, steps = threading.Event(), threading.Event(), Steps()

    def step() -> float:
        entered.set()
        leave.wait(LIMIT)
        return steps()

    worker = Worker("test", step)
    worker.start()
    assert entered.wait(LIMIT)
    worker.wake()
    leave.set()
    assert [steps.came.get(timeout=LIMIT) for _ in range(2)] == [1, 2]
    worker.stop(LIMIT)


@pytest.mark.parametrize("finish", [True, False])
def test_a_last_step_writes_what_still_waits(finish: bool) -> None:
    steps = Steps()
    worker = Worker("test", steps, first=math.inf, finish=finish)
    worker.start()
    worker.stop(LIMIT)
    assert steps.came.empty() is not finish


def test_a_long_step_sees_that_it_is_the_last() -> None:
    entered, ended = threading.Event(), threading.Event()

    def step() -> float:
        entered.set()
        while not worker.stopping:
            threading.Event().wait(0.001)
        ended.set()
        return 0.0

    worker = Worker("test", step)
    worker.start()
    assert entered.wait(LIMIT) and not worker.stopping
    worker.stop(LIMIT)
    assert ended.is_set()
