"""The throttle on guessing passwords: by account and address together, and more gently by each of them alone.

The limit of the pair stops an attacker who guesses at one account. The limit of an address stops one who tries a few
passwords on many accounts, the limit of an account one who has many addresses. A pair that has logged in before is free
of these two, so that no attacker, behind the same router or not, can lock a person out of the place where he works.
"""

import hashlib
import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass

from tms_config.clock import monotonic
from tms_reason.errors import TmsError
from tms_ur.callers import caller
from tms_ur.reasons import Throttled

FORGET = 900.0  # s after which wrong passwords count no more
MAX_KEYS = 2000  # keys of each kind; the one that was unused for longest is dropped


@dataclass(frozen=True)
class Limit:
    """The wait doubles with every wrong password beyond the free ones."""

    free: int
    longest: float  # s


PAIR = Limit(free=3, longest=60.0)
ADDRESS = Limit(free=20, longest=30.0)  # many people may share one address
ACCOUNT = Limit(free=30, longest=5.0)  # short: a right password from a new address has to wait as well


class Failures:
    """Counts wrong passwords by key; the number of keys is bounded."""

    def __init__(self, limit: Limit, clock: Callable[[], float]) -> None:
        self._limit, self._clock = limit, clock
        self._counts: OrderedDict[str, tuple[int, float]] = OrderedDict()

    def wait(self, key: str) -> float:
        """Seconds until the next try."""
        count, last = self._counts.get(key, (0, 0.0))
        beyond = count - self._limit.free
        if beyond <= 0:
            return 0.0
        return max(0.0, last + min(self._limit.longest, 2.0 ** min(beyond, 10)) - self._clock())

    def add(self, key: str) -> None:
        count, last = self._counts.pop(key, (0, self._clock()))
        self._counts[key] = (1 if self._clock() - last > FORGET else count + 1, self._clock())
        if len(self._counts) > MAX_KEYS:
            self._counts.popitem(last=False)

    def clear(self, key: str) -> None:
        self._counts.pop(key, None)

    def take_back(self, key: str) -> None:
        """Take back the last count: the password was right."""
        count, last = self._counts.get(key, (0, 0.0))
        if count > 1:
            self._counts[key] = (count - 1, last)
        else:
            self.clear(key)


class LoginThrottle:
    """Counts every try as wrong until it was right, so that tries at the same time count, too; thread safe."""

    def __init__(self, clock: Callable[[], float] = monotonic) -> None:
        self._pairs, self._addresses, self._accounts = (Failures(one, clock) for one in (PAIR, ADDRESS, ACCOUNT))
        self._familiar: OrderedDict[str, None] = OrderedDict()  # pairs that have logged in
        self._lock = threading.Lock()

    def attempt(self, account: str, address: str) -> None:
        """Count a try.

        Raises:
            TmsError: THROTTLED: the try comes too soon and is not counted.
        """
        pair, address, account = _keys(account, address)
        with self._lock:
            familiar = pair in self._familiar
            wider = 0.0 if familiar else max(self._addresses.wait(address), self._accounts.wait(account))
            wait = max(self._pairs.wait(pair), wider)
            if wait > 0:
                raise TmsError(Throttled(wait))
            self._pairs.add(pair)
            if not familiar:
                self._addresses.add(address)
                self._accounts.add(account)

    def right(self, account: str, address: str) -> None:
        """Note that the try was right; the wrong tries of other callers still count."""
        pair, address, account = _keys(account, address)
        with self._lock:
            self._pairs.clear(pair)
            if self._familiar.pop(pair, False) is False:
                self._addresses.take_back(address)
                self._accounts.take_back(account)
            self._familiar[pair] = None
            if len(self._familiar) > MAX_KEYS:
                self._familiar.popitem(last=False)


def _keys(account: str, address: str) -> tuple[str, str, str]:
    """Keys of the pair, the address and the account; of a fixed length, however long a sent name is."""
    name = hashlib.sha256(account.encode(errors="replace")).hexdigest()
    return f"{name} {caller(address)}", caller(address), name
