"""The controller of `front_cmd`: a queue per joint that delays commands, with the traps of the original. Pure."""

from collections import deque
from collections.abc import Callable, Mapping, Sequence


class Front:
    """Takes joint commands and sets targets of drives, at once or after the dead time of the joint.

    It fills the queues by the frames of the simulator and empties them by steps of the engine. It walks the joints of
    the latest message only, and ends its walk at the first one without dead time. So a message with fewer joints
    freezes the queues of the others.
    """

    def __init__(self, dead_times: Mapping[str, float | None], aim: Callable[[str, float], None]) -> None:
        """`dead_times` [s] of the joints it knows, None for none; `aim` sets a joint's target."""
        self._dead_times, self._aim = dead_times, aim
        self._waiting: dict[str, deque[tuple[float, float]]] = {name: deque() for name in dead_times}  # time, value
        self._latest: Sequence[str] = ()

    def command(self, names: Sequence[str], values: Sequence[float], now: float) -> None:
        """Take a message.

        Raises:
            IndexError: it has less values than names; the joints before are commanded.
        """
        self._latest = names
        for i, name in enumerate(names):
            if name not in self._dead_times:
                continue
            if self._dead_times[name] is None:
                self._aim(name, values[i])
            else:
                self._waiting[name].append((now, values[i]))

    def step(self, now: float) -> None:
        """Set the targets whose dead time is over; of several that are due for a joint the newest one."""
        for name in self._latest:
            dead_time = self._dead_times.get(name)
            if dead_time is None:
                return
            waiting = self._waiting[name]
            due = None
            while waiting and now - waiting[0][0] > dead_time:
                due = waiting.popleft()[1]
            if due is not None:
                self._aim(name, due)

    @property
    def queued(self) -> dict[str, int]:
        """How many commands wait, by joint."""
        return {name: len(waiting) for name, waiting in self._waiting.items() if waiting}
