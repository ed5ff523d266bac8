"""A thread of its own that beats at a fixed rate, and measures how late each beat is.

Leases are asserted here and not on the executor thread: its timers come late when callbacks are long, and each of
their wake-ups costs ten times as much. But the state of the executor decides: while it has been in one callback for
long, or does not answer a request, no lease is asserted. Code that judges another process by its silence first calls
`late`: this process itself, or the whole PC, may not have run meanwhile.
"""

import threading
from collections.abc import Callable
from typing import Protocol

from tms_config.clock import monotonic
from tms_runtime.priority import waited

BEAT = 0.05  # s
LATE = 0.1  # s that a beat may come late before the PC counts as too busy
STOOD_STILL = 0.3  # s without an assertion after which that is logged: for others the process is lost after 0.5 s
REMEMBERED = 1.0  # s for which a late beat is remembered
ASK = 1.0  # s between requests to the executor: each wakes it
STUCK = 0.18  # s in one callback, or without an answer, after which assertions end; with the lease below 0.7 s

Step = Callable[[], None]


class Executor(Protocol):
    """The thread that runs the callbacks of a node."""

    def begin(self, work: Step, name: str) -> threading.Thread:
        """Start a thread whose death ends the process."""

    def on_executor(self, step: Step) -> None:
        """Run a step on the executor thread, soon."""

    def busy_since(self) -> float | None:
        """When the present callback began, monotonic [s]; None while the executor waits."""

    def thread_number(self) -> int | None:
        """The thread's number in the kernel."""

    def on_stop(self, step: Step) -> None:
        """Run a step before the node stops."""


class Lateness:
    """When beats came late. Pure logic, for one writing thread and any reader; times are monotonic [s]."""

    def __init__(self) -> None:
        self._last: float | None = None
        self._late_at = float("-inf")

    def beat(self, now: float) -> float:
        """Note a beat; returns how late it was [s]."""
        last, self._last = self._last, now
        if self._overdue(now, last):
            self._late_at = now
        return 0.0 if last is None else now - last - BEAT

    def late(self, now: float) -> bool:
        """Whether a beat came late a moment ago, or one is overdue now."""
        return self._overdue(now, self._last) or now - self._late_at < REMEMBERED

    def pause(self) -> None:
        """Note that the beats pause on purpose."""
        self._last = None

    @staticmethod
    def _overdue(now: float, last: float | None) -> bool:
        return last is not None and now - last > BEAT + LATE


class Pulse:
    """The pulse of this process. Without steps its thread sleeps, so an idle process uses no processor time."""

    def __init__(self, executor: Executor) -> None:
        self._executor = executor
        self._steps: tuple[Step, ...] = ()
        self._changing = threading.Lock()
        self._wanted, self._closed = threading.Event(), threading.Event()
        self._asked = self._answered = 0.0
        self._lateness = Lateness()
        self._worked: float | None = None  # when this process was last seen to work
        self._waited = 0.0  # s for which its threads had waited for a processor by the last request
        self.stood_still: Callable[[float, float], None] = lambda silent, waited: None  # see `_publish`
        self._thread = executor.begin(self._run, "pulse")
        executor.on_stop(self.close)

    def add(self, step: Step) -> None:
        """Call `step` at every beat from now on, in the pulse's thread; it must be quick."""
        with self._changing:
            if not self._steps:
                self._asked = self._answered = monotonic()
            self._steps = (*(other for other in self._steps if other != step), step)
            self._wanted.set()

    def remove(self, step: Step) -> None:
        """End the calls of `step`; one may still be under way."""
        with self._changing:
            self._steps = tuple(other for other in self._steps if other != step)
            if not self._steps:
                self._wanted.clear()

    def late(self) -> bool:
        """Whether this process, or the whole PC, did not run for a moment just now."""
        return self._lateness.late(monotonic())

    def works(self) -> bool:
        """Whether the executor is in no long callback, and has answered the last request."""
        now, since, asked = monotonic(), self._executor.busy_since(), self._asked
        answered = self._answered >= asked or now - asked < STUCK
        return answered and (since is None or now - since < STUCK)

    def close(self) -> None:
        """End the thread, after a beat that is under way."""
        self._closed.set()
        self._wanted.set()
        self._thread.join(1.0)

    def _run(self) -> None:
        while not self._closed.is_set():
            if not self._wanted.is_set():
                self._lateness.pause()
                self._worked = None
                self._wanted.wait()
            now = monotonic()
            self._lateness.beat(now)
            if self.works():
                self._publish(now)
            self._ask(now)
            for step in self._steps:
                step()
            self._closed.wait(BEAT)

    def _ask(self, now: float) -> None:
        if self._answered >= self._asked and now - self._asked >= ASK:
            self._asked, self._waited = now, self._waits()
            self._executor.on_executor(self._answer)

    def _publish(self, now: float) -> None:
        """Report a long time without assertions [s], and how much of it was spent waiting for a processor [s]."""
        silent = now - (self._worked or now) - BEAT
        self._worked = now
        if silent > STOOD_STILL:
            waits = self._waits()
            self.stood_still(silent, min(silent, waits - self._waited))
            self._waited = waits

    def _waits(self) -> float:
        return waited({number for number in (self._executor.thread_number(), threading.get_native_id()) if number})

    def _answer(self) -> None:
        self._answered = monotonic()
