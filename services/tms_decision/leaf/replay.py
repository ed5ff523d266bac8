"""Leaf goals that ended before a run was interrupted are not done again when it is resumed."""

from collections import defaultdict, deque
from collections.abc import Callable, Iterable

from tms_decision.leaf.events import Key


class Replay:
    """Leaf goals that have ended before: if the tree asks for them again, in the same order, they are not repeated.

    Flags are read anew, so the tree may go another way than before the interruption. Once a goal is really done, the
    goals that the tree has not asked for until then are dropped: if the tree asks for them later, they are done again.
    """

    def __init__(self, ended: Iterable[tuple[Key, bool]] = ()) -> None:
        self.beside: Callable[[str, str], bool] = lambda node, other: False  # whether neither node waits for the other
        self._ended: dict[Key, deque[bool]] = defaultdict(deque)
        for key, succeeded in ended:
            self._ended[key].append(succeeded)

    def take(self, key: Key) -> bool | None:
        """How that leaf goal ended before, each time once; None if it must be done now."""
        found = self._ended.get(key)
        return found.popleft() if found else None

    def moved_on(self, node: str) -> list[tuple[Key, int]]:
        """Drop goals after a goal of `node` was really done: only nodes in parallel branches may still skip theirs.

        Returns the dropped goals, and how often each had ended without being asked for again.
        """
        past = [key for key in list(self._ended) if not self.beside(key[0], node)]
        return [(key, left) for key in past if (left := len(self._ended.pop(key)))]
