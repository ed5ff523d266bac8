"""How many changes of a node go into the history. Pure logic."""

from collections.abc import Callable

from tms_config.clock import monotonic

MAX_BURST = 200  # changes of one node at a time
# s after which a node without budget may record one more change: a loop that waits changes 20 times a second
REFILL_PERIOD = 10.0


class Budget:
    """A budget that suffices for nodes that work, and keeps a loop that waits for long out of the history."""

    def __init__(self, clock: Callable[[], float] = monotonic) -> None:
        self._clock = clock
        self._left: dict[str, tuple[float, float]] = {}  # path -> changes left, when they were counted

    def take(self, path: str) -> bool:
        """Whether a change of a node is recorded."""
        now = self._clock()
        left, counted = self._left.get(path, (float(MAX_BURST), now))
        left = min(float(MAX_BURST), left + (now - counted) / REFILL_PERIOD)
        reported = left >= 1.0
        self._left[path] = (left - reported, now)
        return reported
