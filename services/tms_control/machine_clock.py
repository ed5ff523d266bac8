"""The time of a machine that has a clock of its own, such as a simulator's: slower or faster than ours, with gaps.

Stamps of its messages tell its time. They arrive late by a few hundredths of a second, now more, now less; a line
through the last of them evens that out. Its mean lateness stays: it counts as a part of the dead time.
"""

from collections import deque

import numpy as np

KEPT = 2.0  # s of messages that the line is drawn through
FEW = 10  # messages, below which its clock counts as fast as ours
GAP = 0.5  # s without a message, after which its clock may have stood still: the line begins anew
RUNS_ON = 0.25  # s that its clock is trusted to go on after its last message
SLOWEST, FASTEST = 0.05, 20.0  # its seconds in one of ours; beyond them the stamps are wrong


class MachineClock:
    """Turns our time into the machine's."""

    def __init__(self) -> None:
        self._heard: deque[tuple[float, float]] = deque()  # s ours, s its
        self._rate, self._offset = 1.0, 0.0  # its = offset + rate * (ours - arrival of the last message)

    @property
    def rate(self) -> float:
        """How many of its seconds are in one of ours."""
        return self._rate

    @property
    def stamp(self) -> float | None:
        """The stamp of its last message [s], None before the first."""
        return self._heard[-1][1] if self._heard else None

    def hear(self, arrived: float, stamp: float) -> bool:
        """Take a message; returns False if its clock was set back: no time before counts any more."""
        back = False
        if self._heard:
            before, last = self._heard[-1]
            if stamp == last:
                return True
            back = stamp < last
            if back or arrived - before > GAP:
                self._heard.clear()
        self._heard.append((arrived, stamp))
        while arrived - self._heard[0][0] > KEPT:
            self._heard.popleft()
        self._fit()
        return not back

    def now(self, ours: float) -> float | None:
        """Its time [s] at a time of ours, None before the first message."""
        if not self._heard:
            return None
        arrived, stamp = self._heard[-1]
        since = min(ours - arrived, RUNS_ON)
        return max(stamp, self._offset + self._rate * since)

    def time(self, ours: float) -> float:
        """As `now`, for who knows that it was heard."""
        its = self.now(ours)
        assert its is not None, "before its first message nothing moves"
        return its

    def silent(self, ours: float) -> float:
        """How long no message has come [s of ours]."""
        return ours - self._heard[-1][0] if self._heard else float("inf")

    def _fit(self) -> None:
        arrived, stamp = self._heard[-1]
        if len(self._heard) < FEW:
            self._rate, self._offset = 1.0, stamp
            return
        ours, its = (np.array(column) for column in zip(*self._heard, strict=True))
        rate, offset = np.polyfit(ours - arrived, its, 1)
        self._rate, self._offset = float(np.clip(rate, SLOWEST, FASTEST)), float(offset)
