"""The task numbers in use, kept for a moment: reading all tasks for each new one takes too long."""

from collections.abc import Callable, Iterator
from itertools import count, islice
from typing import Any

from pymongo.collection import Collection

from tms_config.clock import monotonic

KEPT = 2.0  # s: other programs may store and remove tasks in the same database


class TaskNumbers:
    """For one caller at a time. The unique index of the store decides."""

    def __init__(self, tasks: Collection[dict[str, Any]], clock: Callable[[], float] = monotonic) -> None:
        self._tasks, self._clock = tasks, clock
        self._taken: set[Any] = set()
        self._foreign = False
        self._until = float("-inf")

    def lowest_free(self, how_many: int) -> list[int]:
        """Numbers from 1 that no task has."""
        self._refresh()
        return list(islice(self._free(), how_many))

    def foreign(self) -> bool:
        """Whether there are tasks of the C++ system, which have no hash of their text."""
        self._refresh()
        return self._foreign

    def took(self, number: int) -> None:
        """Note that a task has this number now."""
        self._taken.add(number)

    def forget(self) -> None:
        """Read the numbers again next time: another program has stored or removed a task."""
        self._until = float("-inf")

    def _free(self) -> Iterator[int]:
        return (number for number in count(1) if number not in self._taken)

    def _refresh(self) -> None:
        if self._clock() < self._until:
            return
        until = self._clock() + KEPT
        found = list(self._tasks.find({}, {"_id": 0, "task_id": 1, "text_sha256": 1}))
        self._taken = {document.get("task_id") for document in found}
        self._foreign = any("text_sha256" not in document for document in found)
        self._until = until
