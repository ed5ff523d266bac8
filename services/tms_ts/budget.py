"""How many changes of a node go into the history. Pure logic."""

from collections.abc import Callable

from tms_config.clock import monotonic

AT_ONCE = 200  # changes of one node ...
EVERY = 10.0  # s ... and of a node that has used them up, one in so long: a loop that waits changes 20 times a second


class Budget:
    """Enough for nodes that work, and little for those of a loop that only waits, however long."""

    def __init__(self, clock: Callable[[], float] = monotonic) -> None:
        self._clock = clock
        self._left: dict[str, tuple[float, float]] = {}  # path -> changes left, when they were counted

    def take(self, path: str) -> bool:
        """Whether the change of a node is told."""
        now = self._clock()
        left, counted = self._left.get(path, (float(AT_ONCE), now))
        left = min(float(AT_ONCE), left + (now - counted) / EVERY)
        told = left >= 1.0
        self._left[path] = (left - told, now)
        return told
