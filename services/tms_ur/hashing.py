"""Verifies passwords and tokens one at a time, in a short queue with a bounded number of entries an address."""

from collections import Counter
from collections.abc import Callable
from typing import TypeVar

import anyio
import anyio.to_thread

from tms_reason.errors import TmsError
from tms_ur.callers import caller
from tms_ur.reasons import ManyLogins

MAX_WAITING = 16  # verifications; each takes 19 MB and some 30 ms while it runs
MAX_OF_ONE = 2  # of them from one address, so that a guesser leaves room for others

T = TypeVar("T")


class Hashing:
    """Used on the event loop only. Stops have a queue of their own, so that they do not wait for logins."""

    def __init__(self) -> None:
        self._lane, self._stop_lane = anyio.CapacityLimiter(1), anyio.CapacityLimiter(1)
        self._waiting: Counter[tuple[bool, str]] = Counter()

    async def run(self, address: str, work: Callable[[], T], stop: bool = False) -> T:
        """Run `work` in a thread when it is its turn.

        Raises:
            TmsError: MANY_LOGINS, or what `work` raises.
        """
        key = (stop, caller(address))
        others = sum(count for (lane, _), count in self._waiting.items() if lane is stop)
        if others >= MAX_WAITING or self._waiting[key] >= MAX_OF_ONE:
            raise TmsError(ManyLogins())
        self._waiting[key] += 1
        try:
            return await anyio.to_thread.run_sync(work, limiter=self._stop_lane if stop else self._lane)
        finally:
            self._waiting[key] -= 1
            if not self._waiting[key]:
                del self._waiting[key]
