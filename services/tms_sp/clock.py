"""The clock of a source: how far it is off, told from stamps, and how old a message is all the same.

The shortest way of the last seconds counts as no delay at all, so the offset holds the usual delay of the network; what
takes longer than that is the age of a message.
"""

WINDOW = 10.0  # s


class SourceClock:
    def __init__(self, limit: float) -> None:
        """`limit`: s that the source may be off."""
        self._limit = limit
        self._began = 0.0
        self._least: list[float] = []  # of the window before and of this one

    @property
    def offset(self) -> float | None:
        """S that our clock is ahead of the source's; None before the first stamp."""
        return min(self._least) if self._least else None

    @property
    def off(self) -> bool:
        """Whether somebody should set the source's clock."""
        return self.offset is not None and abs(self.offset) > self._limit

    def ahead(self, stamp: float, now: float) -> float:
        """S that a stamp lies further in the future than allowed; 0 if it does not."""
        return max(0.0, stamp - now - self._limit)

    def age(self, stamp: float, now: float) -> float:
        """S between measurement and arrival, beyond the usual."""
        if not self._least or not 0 <= now - self._began <= WINDOW:  # below 0: our clock was set back
            self._least, self._began = [*self._least[-1:], now - stamp], now
        self._least[-1] = min(self._least[-1], now - stamp)
        return now - stamp - min(self._least)
