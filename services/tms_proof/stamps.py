"""The stamps of one source: their times on this PC's clock, and whether they can be believed. Pure logic."""

from dataclasses import dataclass
from enum import Enum

from tms_proof.facts import Stamps
from tms_proof.reasons import ClockAhead, ClockBack, SimulatorClock, UtcClock
from tms_reason.reason import Reason

AHEAD = 1.0  # s that a stamp may be ahead of its estimated offset
BACK = 0.5  # s that a stamp may be before the last one; further back means a new clock
REMEMBERED = 30.0  # s for which the smallest delay is remembered: clocks drift
CLOCKS: dict[str, Reason] = {"utc": UtcClock(), "since_start": SimulatorClock()}


class StampVerdict(Enum):
    """What a stamp shows about its message."""

    NEW = "measured after the one before"
    REPEATED = "not measured after the one before"
    NEW_CLOCK = "of another clock than the ones before"


@dataclass(frozen=True)
class Judged:
    """`measured` is on this PC's monotonic clock [s]; `why` is set for a new clock."""

    verdict: StampVerdict
    measured: float
    why: Reason | None = None


class StampClock:
    """Estimates the offset of a source's clock: the smallest delay between measurement and reception."""

    def __init__(self, kind: Stamps) -> None:
        self.kind = kind
        self._last: float | None = None
        self._delay: float | None = None  # s, the smallest of this period
        self._delay_before: float | None = None  # and of the period before
        self._begun = 0.0

    def judge(self, received: float, stamp: float) -> Judged:
        """Take one stamp [s of its own clock]; `received` is monotonic [s]."""
        if self.kind == "none":
            return Judged(StampVerdict.NEW, received)
        delay, known = received - stamp, self._offset()
        if known is not None and known - delay > AHEAD:
            return self._begin(received, stamp, ClockAhead(known - delay, CLOCKS[self.kind]))
        if self._last is not None and stamp < self._last - BACK:
            return self._begin(received, stamp, ClockBack(CLOCKS[self.kind], self._last - stamp))
        if self._last is not None and stamp <= self._last:
            return Judged(StampVerdict.REPEATED, self._last + self._known())
        self._last = stamp
        self._learn(received, delay)
        return Judged(StampVerdict.NEW, stamp + self._known())

    def _begin(self, received: float, stamp: float, why: Reason) -> Judged:
        """Begin anew: all estimates of the old clock are void."""
        self._last, self._delay, self._delay_before, self._begun = stamp, received - stamp, None, received
        return Judged(StampVerdict.NEW_CLOCK, received, why)

    def _learn(self, received: float, delay: float) -> None:
        if self._delay is None:
            self._delay, self._begun = delay, received
        elif received - self._begun > REMEMBERED:
            self._delay_before, self._delay, self._begun = self._delay, delay, received
        else:
            self._delay = min(self._delay, delay)

    def _offset(self) -> float | None:
        if self._delay is None or self._delay_before is None:
            return self._delay
        return min(self._delay, self._delay_before)

    def _known(self) -> float:
        known = self._offset()
        assert known is not None, "learnt just before"
        return known
