"""A thread that works at a fixed pace while a goal is open, and else looks now and then at what the machine tells."""

import threading
from collections.abc import Callable

from tms_config.clock import monotonic, sleep
from tms_ros.node import Ros

IDLE = 0.1  # s between looks while nothing moves the machine


class Turns:
    """`step` gets the time [s] since the last one, 0 while no goal was open, and says whether one is open."""

    def __init__(self, ros: Ros, step: Callable[[float], bool], period: float, name: str) -> None:
        """`period` [s] between steps while a goal is open."""
        self._ros, self._step, self._period = ros, step, period
        self._woken = threading.Event()
        ros.loop.begin(self._run, name)

    def wake(self) -> None:
        """Look at once: a goal has begun."""
        self._woken.set()

    def _run(self) -> None:
        last: float | None = None
        while not self._ros.closing:
            now = monotonic()
            if self._step(0.0 if last is None else now - last):
                last = now
                sleep(self._period)
            else:
                last = None
                self._woken.wait(IDLE)
                self._woken.clear()
