"""Leaf goals that ended before a run was interrupted are not done again when it is resumed. Pure logic."""

from collections import defaultdict, deque
from collections.abc import Callable

from tms_ts.interrupted_run import Key


class Replay:
    """Leaf goals that have ended before: asked for again, in the same order, they are not repeated.

    Flags are read anew, so the tree may go another way than before the interruption. What it has not asked for when
    a goal is really done belongs to the past, and is done again should the tree come there later.
    """

    def __init__(self, ended: list[tuple[Key, bool]]) -> None:
        self.beside: Callable[[str, str], bool] = lambda node, other: False  # whether neither waits for the other
        self._ended: dict[Key, deque[bool]] = defaultdict(deque)
        for key, succeeded in ended:
            self._ended[key].append(succeeded)

    def take(self, key: Key) -> bool | None:
        """How that leaf goal ended, once; None if it has to be done now."""
        found = self._ended.get(key)
        return found.popleft() if found else None

    def moved_on(self, node: str) -> list[tuple[Key, int]]:
        """A goal of that node was really done: only nodes beside it may still have something to skip.

        Returns what is dropped: how often each leaf goal had ended and was not asked for again.
        """
        past = [key for key in list(self._ended) if not self.beside(key[0], node)]
        dropped = [(key, len(self._ended.pop(key, ()))) for key in past]
        return [(key, left) for key, left in dropped if left]
