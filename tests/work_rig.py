"""Samples of a machine that works, made in virtual time: for the tests of cycles."""

from collections.abc import Iterable
from typing import Any

from tms_work.cycle import Cycle
from tms_work.recogniser import Recogniser
from tms_work.sample import Amount, Sample

BEGIN = 1.8e9  # s since 1970
HEAPED = 0.9  # m3 of a bucket
PERIOD = 0.2  # s
DENSITY, SWELL = 1150.0, 1.28  # kg/m3 loose, and loose by bank volume


def amount(loose: float) -> Amount:
    """So much loose soil [m3]."""
    return Amount(loose * DENSITY, loose / SWELL, loose)


class Tape:
    """What a machine tells, one stretch after another."""

    def __init__(self) -> None:
        self.time, self.loose, self.x = BEGIN, 0.0, 0.0
        self.kept: dict[str, Any] = {"run": "r1", "soil": "earth"}
        self.samples = [self._sample()]

    def go(self, seconds: float, loose: float | None = None, to: float | None = None, **fields: Any) -> "Tape":
        """Go on for a time; the load [m3] and the place along x [m] change evenly to new values."""
        count, load, x = max(1, round(seconds / PERIOD)), self.loose, self.x
        end, there = load if loose is None else loose, x if to is None else to
        for k in range(1, count + 1):
            share = k / count
            self.time += PERIOD
            self.loose, self.x = load + (end - load) * share, x + (there - x) * share
            self.samples.append(self._sample(**{"moves": True} | fields))
        return self

    def _sample(self, **fields: Any) -> Sample:
        return Sample(self.time, amount(self.loose), x=self.x, **self.kept | fields)


def bucket(tape: Tape, loose: float, truck: str = "ic120_1") -> Tape:
    """Dig until so much [m3] is in the bucket, and dump it into a truck, or to the ground."""
    return tape.go(5, loose, cuts=True).go(4, swing=0.5).go(2, 0.0, under=truck).go(3, swing=-0.5)


def taken(recogniser: Recogniser, samples: Iterable[Sample]) -> list[Cycle]:
    return [cycle for sample in samples for cycle in recogniser.take(sample)]
