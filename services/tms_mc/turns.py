"""A thread that works at a fixed pace while a goal is open, and else looks now and then at what the machine tells."""

import threading
from collections.abc import Callable

from tms_config.clock import sleep
from tms_ros.node import Ros

IDLE = 0.1  # s between looks while nothing moves the machine


class Turns:
    """`step` says whether a goal is open."""

    def __init__(self, ros: Ros, step: Callable[[], bool], period: float, name: str) -> None:
        """`period` [s] between steps while a goal is open."""
        self._ros, self._step, self._period = ros, step, period
        self._woken = threading.Event()
        ros.loop.begin(self._run, name)

    def wake(self) -> None:
        """Look at once: a goal has begun."""
        self._woken.set()

    def _run(self) -> None:
        while not self._ros.closing:
            if self._step():
                sleep(self._period)
            else:
                self._woken.wait(IDLE)
                self._woken.clear()
