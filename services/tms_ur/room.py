"""Bounds the requests that are answered at a time. Stops are not counted: there is always room for one."""

import re
from collections import Counter

from starlette.types import Scope

MAX_REQUESTS = 250  # requests that are answered at a time, streams among them
MAX_OF_ONE = 100  # of them from one address; more than the hanging ones that connections.py allows it
STOPS = re.compile(r"/api/(stop|runs/[^/]+/cancel)")


def is_stop(scope: Scope) -> bool:
    """Whether a request asks for machines to stop."""
    return scope["method"] == "POST" and STOPS.fullmatch(scope["path"]) is not None


class Room:
    """Counts requests by caller; used on the event loop only."""

    def __init__(self) -> None:
        self._open: Counter[str] = Counter()

    def enter(self, who: str) -> bool:
        """Count a request; returns whether it may be answered. If so, `leave` must follow its end."""
        if self._open.total() >= MAX_REQUESTS or self._open[who] >= MAX_OF_ONE:
            return False
        self._open[who] += 1
        return True

    def leave(self, who: str) -> None:
        self._open[who] -= 1
        if not self._open[who]:
            del self._open[who]
