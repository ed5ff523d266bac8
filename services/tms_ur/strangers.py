"""Sums up refused requests: at most one entry a minute for each address and kind. Pure logic."""

import threading
from collections.abc import Callable
from dataclasses import dataclass

from tms_config.clock import monotonic
from tms_ur.callers import caller

COUNTING_PERIOD = 60.0  # s
MAX_KINDS = 200  # pairs of address and kind; further ones are counted together
MANY = "many addresses"


@dataclass
class RefusalGroup:
    """Refusals that become one entry."""

    who: str  # the last name that was given
    source: str
    what: str
    why: str
    since: float
    times: int = 0


class Strangers:
    """Thread safe; the memory that it needs does not grow with the number of refusals."""

    def __init__(self, clock: Callable[[], float] = monotonic) -> None:
        self._clock = clock
        self._open: dict[tuple[str, str, str], RefusalGroup] = {}
        self._lock = threading.Lock()

    def add(self, who: str, source: str, what: str, why: str) -> bool:
        """Count a refusal; True if it is the first of its kind, which is recorded at once."""
        with self._lock:
            key = (caller(source), what, why)
            if key not in self._open and len(self._open) >= MAX_KINDS:
                source, key = MANY, (MANY, what, why)
            found = self._open.get(key)
            if found is None:
                self._open[key] = RefusalGroup(who, source, what, why, self._clock())
                return True
            found.who, found.times = who, found.times + 1
            return False

    def due(self, everything: bool = False) -> list[RefusalGroup]:
        """The counts since the last entry of each kind, where that is a minute ago."""
        with self._lock:
            now = self._clock()
            over = {key: one for key, one in self._open.items() if everything or now - one.since >= COUNTING_PERIOD}
            for key, one in over.items():
                if one.times:
                    self._open[key] = RefusalGroup(one.who, one.source, one.what, one.why, now)
                else:
                    del self._open[key]
        return [one for one in over.values() if one.times]
