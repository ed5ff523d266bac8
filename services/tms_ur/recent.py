"""When something happened lately, by what it happened to. Pure logic."""

from collections import defaultdict, deque
from collections.abc import Iterator

MOST = 20  # events of one subject that are remembered; no rule asks for more


class Recent:
    """Events with their times; the memory that it needs does not grow with their number."""

    def __init__(self) -> None:
        self._at: defaultdict[str, deque[float]] = defaultdict(lambda: deque(maxlen=MOST))

    def put(self, subject: str, at: float) -> None:
        """Remember an event."""
        self._at[subject].append(at)

    def above(self, most: float, since: float) -> Iterator[str]:
        """The subjects with more than `most` events after `since`."""
        return (subject for subject, times in self._at.items() if sum(at > since for at in times) > most)
