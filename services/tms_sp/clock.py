"""Estimates from stamps how far the clock of a source is off, and how old a message is nevertheless.

The shortest delay of the last seconds counts as none, so the offset includes the usual delay of the network; the delay
beyond that is the age of a message.
"""

from tms_sp.mapping import MessageRefused
from tms_sp.reasons import MeasuredEarlier, StampInFuture

WINDOW = 10.0  # s


class SourceClock:
    """Judges the stamps of one source against the clock of this PC."""

    def __init__(self, limit: float) -> None:
        """`limit`: s that the source may be off."""
        self._limit = limit
        self._began = 0.0
        self._least: list[float] = []  # least delay [s] of the window before and of this one

    @property
    def offset(self) -> float | None:
        """Seconds that our clock is ahead of the source's; None before the first stamp."""
        return min(self._least) if self._least else None

    @property
    def off(self) -> bool:
        """Whether the source's clock is off by more than the limit."""
        return self.offset is not None and abs(self.offset) > self._limit

    def ahead(self, stamp: float, now: float) -> float:
        """Seconds that a stamp lies further in the future than allowed; 0 if it does not."""
        return max(0.0, stamp - now - self._limit)

    def check(self, stamp: float, before: float | None, now: float) -> None:
        """Refuse what must not follow a message of the same source with the stamp `before`.

        Raises:
            MessageRefused: StampInFuture, MeasuredEarlier.
        """
        if (ahead := self.ahead(stamp, now)) > 0:
            raise MessageRefused(StampInFuture(ahead + self._limit))
        set_back = before is not None and self.ahead(before, now) > 0  # our clock was, after the stamp came
        if before is not None and stamp < before and not set_back:
            raise MessageRefused(MeasuredEarlier(before - stamp))

    def age(self, stamp: float, now: float) -> float:
        """Seconds between measurement and arrival, beyond the usual delay."""
        if not self._least or not 0 <= now - self._began <= WINDOW:  # below 0: our clock was set back
            self._least, self._began = [*self._least[-1:], now - stamp], now
        self._least[-1] = min(self._least[-1], now - stamp)
        return now - stamp - min(self._least)
