"""Runs steps of another thread on the executor."""

import threading
from collections.abc import Callable
from typing import TypeVar

from tms_if.reasons import ExecutorBusy
from tms_reason.errors import RosError
from tms_ros.node import Ros

T = TypeVar("T")


def do(ros: Ros, step: Callable[[], T], seconds: float) -> T:
    """Run `step` on the executor thread and wait for what it returns or raises; from worker threads only.

    Raises:
        RosError: the executor did not run it within `seconds`.
    """
    there = threading.Event()
    results: list[T] = []
    errors: list[Exception] = []

    def run() -> None:
        try:
            results.append(step())
        except Exception as error:  # raised in the caller's thread; raised here it would end the executor
            errors.append(error)
        there.set()

    ros.on_executor(run)
    if not there.wait(seconds):
        raise RosError(ExecutorBusy(seconds))
    if errors:
        raise errors[0]
    return results[0]
