"""Queue of commands that take effect after a dead time. Pure logic."""

from collections import deque
from collections.abc import Iterator
from typing import Generic, TypeVar

T = TypeVar("T")
MAX_COMMANDS = 10_000  # commands under way; beyond it the oldest ones are lost
EARLY = 1e-6  # s, a command that is due within this is due


class DeadTime(Generic[T]):
    """A first-in, first-out queue; each command is due a dead time after it was sent."""

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self._under_way: deque[tuple[float, T]] = deque(maxlen=MAX_COMMANDS)

    def __len__(self) -> int:
        return len(self._under_way)

    @property
    def under_way(self) -> Iterator[T]:
        """The commands that are not due yet."""
        return (command for _, command in self._under_way)

    def put(self, now: float, command: T, more: float = 0.0) -> None:
        """Send a command; `more` [s] is added to the dead time."""
        self._under_way.append((now + self._seconds + more, command))

    def due(self, now: float) -> Iterator[T]:
        """Take the commands that are due, the oldest first."""
        while self._under_way and self._under_way[0][0] <= now + EARLY:
            yield self._under_way.popleft()[1]

    def clear(self) -> None:
        """Drop the commands under way."""
        self._under_way.clear()
