"""A node, the thread of its executor, and threads for work that may block.

All callbacks share a reentrant group: with rclpy's default group, a callback that awaits an answer keeps the answer
from being delivered. One thread runs them all, so no two run at the same time.
"""

import threading
from collections.abc import Awaitable, Callable
from contextlib import AbstractContextManager, nullcontext, suppress
from contextvars import copy_context
from queue import SimpleQueue
from typing import Any

import rclpy
from builtin_interfaces.msg import Time
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.context import Context
from rclpy.exceptions import InvalidHandle as InvalidHandle  # also for those who do not know rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future

from tms_config.clock import monotonic, sleep
from tms_reason.errors import RosError
from tms_reason.reason import Reason
from tms_ros.executor import KeepingExecutor

POLL = 0.02  # s between checks of the ROS graph, which has no cheap event in rclpy
IDLE = 64  # threads that wait for work, at most


class EventLoop:
    """A node, the thread that runs its callbacks, and the steps and coroutines that run there, too."""

    def __init__(
        self, name: str, namespace: str = "/", process: str = "", creating: AbstractContextManager[None] | None = None
    ) -> None:
        """`process` is the name that people know, as `tms ps` lists it; the node is made inside of `creating`."""
        self.process = process or name
        self._context = Context()
        rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        with creating or nullcontext():
            self.node: Node = rclpy.create_node(  # no service that nobody uses: every process discovers each one
                name, namespace=namespace, context=self._context, start_parameter_services=False, enable_rosout=False,
                parameter_overrides=[Parameter("start_type_description_service", value=False)],
            )  # fmt: skip
        self.group = ReentrantCallbackGroup()
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)  # a node's own clock stands still when NTP sets it back
        self._executor = KeepingExecutor(self._context)
        self._executor.add_node(self.node)
        self.failed = threading.Event()  # a thread of this node died of an exception: the whole process must end
        self.closing = False  # no message can be sent any more
        self._ends: list[Callable[[], None]] = []
        self._idle: list[SimpleQueue[Callable[[], object]]] = []  # of threads that wait for work
        self._thread = self.begin(self._spin, "ros")

    def busy_since(self) -> float | None:
        """When the present callback of the executor began, monotonic [s]; None while it waits."""
        return self._executor.busy_since

    def is_current(self) -> bool:
        """Whether the caller is on the executor thread."""
        return threading.current_thread() is self._thread

    def thread_number(self) -> int | None:
        """The executor thread's number in the kernel."""
        return self._thread.native_id

    def on_stop(self, step: Callable[[], None]) -> None:
        """Run `step` before this node stops."""
        self._ends.append(step)

    def begin(self, work: Callable[[], None], name: str) -> threading.Thread:
        """Start a thread that does `work`; if it dies of an exception, the process ends."""

        def run() -> None:
            try:
                work()
            finally:
                if not self.closing:
                    self.failed.set()

        thread = threading.Thread(target=run, name=name, daemon=True)
        thread.start()
        return thread

    def in_thread(self, work: Callable[[], object]) -> None:
        """Do `work` in a thread that waits for some, or a new one: beside busy ones, that takes 0.5 ms to start."""
        try:
            waiting = self._idle.pop()
        except IndexError:
            waiting = SimpleQueue()
            threading.Thread(target=self._work, args=(waiting,), name="work", daemon=True).start()
        waiting.put(work)

    def _work(self, given: SimpleQueue[Callable[[], object]]) -> None:
        copy_context().run(given.get())  # what it binds for the log ends with it
        while len(self._idle) < IDLE:
            self._idle.append(given)
            copy_context().run(given.get())

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except InvalidHandle:  # on a busy PC, the node may be gone before the last callback has ended
            if not self.closing:
                raise

    def stop(self) -> None:
        """End the thread: no message is received any more."""
        self.closing = True
        for step in self._ends:
            step()
        self._executor.shutdown(timeout_sec=0.5)
        self._thread.join(0.5)

    def leave(self) -> None:
        """Leave the graph, after `stop`. DDS hangs here now and then, see `last_resort`."""
        self.node.destroy_node()
        rclpy.shutdown(context=self._context)

    def on_executor(self, step: Callable[[], None]) -> None:
        """Run `step` on the executor thread, soon, after the steps of earlier calls."""
        if threading.current_thread() is self._thread:
            step()
        else:
            self._executor.create_task(step)

    def start(self, step: Callable[[], Awaitable[None]]) -> None:
        """Run a coroutine function on the executor thread; it begins after the steps of earlier calls."""
        self._executor.create_task(step)

    def create_future(self) -> Future:
        """A result that coroutines on the executor thread await; set it there, see `on_executor`."""
        return Future(executor=self._executor)

    def now(self) -> Time:
        """Present time as builtin_interfaces/Time."""
        stamp: Time = self.node.get_clock().now().to_msg()
        return stamp

    def wait_for(self, there: Callable[[], bool], seconds: float, otherwise: Reason) -> None:
        """Poll `there` until it holds.

        Raises:
            RosError: `otherwise`, when it did not hold within `seconds`, or this node has ended meanwhile.
        """
        deadline = monotonic() + seconds
        while self.closing or not there():
            if self.closing or monotonic() > deadline:
                raise RosError(otherwise)
            sleep(POLL)

    # times

    def every(self, seconds: float, step: Callable[[], None]) -> Any:
        """Call `step` on the executor thread at a fixed rate."""
        return self.node.create_timer(seconds, step, callback_group=self.group, clock=self._steady)

    def poll_in_thread(self, seconds: float, step: Callable[[], object], name: str) -> None:
        """Call `step` at a fixed rate in a thread of its own, if it only samples: this costs a tenth of a timer."""

        def sample() -> None:
            with suppress(InvalidHandle):  # the node was destroyed
                while not self.closing:
                    step()
                    sleep(seconds)

        self.begin(sample, name)

    def after(self, seconds: float, step: Callable[[], None]) -> None:
        """Call `step` on the executor thread once, after `seconds`. On the executor thread only."""

        def once() -> None:
            self.node.destroy_timer(timer)
            step()

        timer = self.every(seconds, once)

    async def pause(self, seconds: float) -> None:
        """Have a coroutine wait."""
        over = self.create_future()
        self.after(seconds, lambda: over.set_result(None))
        await over
