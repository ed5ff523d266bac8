"""rclpy's executor, without what that does anew for each callback: list all entities and make a wait set, twice.

That was half of the processor time of an idle process. It uses private parts of rclpy, as privates.py does.
"""

from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from operator import attrgetter
from typing import Any

from rclpy.context import Context
from rclpy.exceptions import InvalidHandle
from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.task import Task
from rclpy.waitable import NumberOfEntities

from tms_config.clock import monotonic

KINDS = ("timer", "subscription", "client", "service")  # in the order in which rclpy executes what is ready
# Fast DDS has lost a wake-up: once in an hour of a full PC, an executor that looked at nothing waited for ever.
LONGEST_WAIT = 10**9  # ns


class KeepingExecutor(SingleThreadedExecutor):  # type: ignore[misc]
    """Keeps its wait set until an entity comes or goes, and executes all that is ready before it waits again.

    Nodes have no guard conditions; groups of callbacks are executed always or never; tasks begin in their order.
    """

    busy_since: float | None = None  # when its present callback began, monotonic [s]; None while it waits

    def __init__(self, context: Context) -> None:
        super().__init__(context=context)
        self._changed = True  # entities came or went since the wait set was made
        self._unfinished: list[Task] = []  # coroutines that wait for a future

    def wake(self) -> None:
        """Called by rclpy when an entity has come or gone."""
        self._changed = True
        super().wake()

    def spin(self) -> None:
        """Execute callbacks until the context or this executor ends."""
        guard, waiting = self._guard, None  # `shutdown` drops its guard condition
        with ExitStack() as held:
            while self._context.ok() and not self._is_shutdown:
                again = self._run_tasks()
                if waiting is None or self._changed:
                    self._changed = False  # first: what changes while the set is made makes it anew
                    held.close()
                    waiting = _WaitSet(self, guard, held)
                self.busy_since = None
                for kind, entity in waiting.ready(0 if again else LONGEST_WAIT):
                    if self._is_shutdown:
                        return
                    self._execute(kind, entity)

    def _run_tasks(self) -> bool:
        """Go on with all tasks; whether one that waits may wait for one that has ended."""
        with self._tasks_lock:
            tasks, self._unfinished = [*self._unfinished, *(task for task, _, _ in self._tasks)], []
            self._tasks.clear()
        for task in tasks:
            self._run(task)
        return 0 < len(self._unfinished) < len(tasks)

    def _execute(self, kind: str, entity: Any) -> None:
        try:
            work = getattr(self, f"_take_{kind}")(entity)
        except InvalidHandle:  # a callback of the same round has destroyed it
            return
        if work is not None:
            self._run(Task(work, executor=self))

    def _run(self, task: Task) -> None:
        self.busy_since = monotonic()
        task()
        if task.done():
            task.result()  # raises what the task has raised
        elif not task.cancelled():
            self._unfinished.append(task)


class _WaitSet:
    """What the nodes of an executor wait for; none of it is destroyed before `held` is closed."""

    def __init__(self, executor: KeepingExecutor, guard: Any, held: ExitStack) -> None:
        def living(kind: str, handle_of: Callable[[Any], Any]) -> Iterator[Any]:
            found = [one for node in executor.get_nodes() for one in getattr(node, f"{kind}s")]
            for one in filter(executor.can_execute, found):
                with suppress(InvalidHandle):  # destroyed meanwhile
                    held.enter_context(handle_of(one))
                    yield one

        self._waitables = list(living("waitable", lambda one: one))
        handle, context = attrgetter("handle"), executor.context.handle
        self._entities = {kind: {one.handle.pointer: one for one in living(kind, handle)} for kind in KINDS}
        timers, subscriptions, clients, services = map(len, self._entities.values())
        counts = NumberOfEntities(subscriptions, 1, timers, clients, services)
        counts = sum((one.get_num_entities() for one in self._waitables), counts)
        held.enter_context(guard.handle)
        held.enter_context(context)
        self._set = rclpy_implementation.WaitSet(*(getattr(counts, part) for part in counts.__slots__), context)
        self._adds = [(self._set.add_guard_condition, guard.handle)]
        for kind, entities in self._entities.items():
            if kind != "client":  # see `ready`
                self._adds += [(getattr(self._set, f"add_{kind}"), one.handle) for one in entities.values()]

    def ready(self, longest: int) -> Iterator[tuple[str, Any]]:
        """Wait for at most `longest` [ns], or until the executor is woken; what is ready, with its kind."""
        self._set.clear_entities()
        for add, handle in self._adds:
            add(handle)
        for one in self._entities["client"].values():
            if one._pending_requests:  # a large scheduler has hundreds of clients, each 5 us of every wake-up
                self._set.add_client(one.handle)
        for one in self._waitables:
            with suppress(InvalidHandle):  # destroyed meanwhile
                one.add_to_wait_set(self._set)
        self._set.wait(longest)
        yield from (("waitable", one) for one in self._waitables if one.is_ready(self._set))
        for kind, entities in self._entities.items():
            for pointer in self._set.get_ready_entities(kind):
                one = entities.get(pointer)  # None: it belongs to an action
                if one is not None and (kind != "timer" or one.handle.is_timer_ready()):  # or cancelled meanwhile
                    yield kind, one
