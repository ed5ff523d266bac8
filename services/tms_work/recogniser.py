"""Recognises the cycles of a machine in its samples.

A cycle ends when the load is out, so it counts at once; the way back belongs to the next one. What is true of buckets:

- Soil that falls out on the way is spilled, not moved, until SPILL of the load has gone or a carrier is below.
- What falls out where it was dug has not been moved; the dig goes on.
- A bucket that is emptied in several goes is one cycle: rests count until soil comes in again.
- A run that ends and a clock that goes back end a cycle, and so does a silence in which soil was poured; it counts if
  soil was moved. The load stays in the bucket, and counts where it is dumped. Work without a run is not counted.
- The time of a silence is in no part: it is told as unseen.
- An estimated load does not grow while we are away. If it has, a ground of an earlier time was brought back, and what
  is in the bucket has been counted already. What a PC that has much to do tells late has happened.
"""

import math
from typing import Any

from pydantic import BaseModel, ConfigDict, Field

from tms_work.cycle import Cycle, Kind
from tms_work.draft import Draft
from tms_work.sample import Sample
from tms_work.ways import Way

STEP = 0.2  # s between two samples that are taken at least: loads are told with noise
GAP = 5.0  # s of silence in which anything may have happened
LOST = 1.0  # s, that a restart takes at least
FLOWS = 0.005  # of the heaped volume in a second; what is slower is noise, or trickles
LEAST = 0.02  # of the heaped volume, below which nothing is carried
SPILL = 0.25  # of the load, that may fall out on the way
REST = 0.1  # of what was poured, that may stick in an emptied bucket
STICKS = 0.05  # of the rest in a second; what goes out more slowly sticks
SWINGS = 0.05  # rad/s
LEAVES = 1.0  # m, from where it was filled
RUNS = 1000  # whose numbers are remembered


class State(BaseModel):
    """What a recogniser must remember."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    before: Sample | None = None  # the last one that was taken
    draft: Draft | None = None  # None: no run holds the machine
    numbers: dict[str, int] = Field(default_factory=dict)  # of the last cycle, by run
    first: int = Field(ge=1, default=1)  # number of the first cycle of a run


class Recogniser:
    """Makes cycles of the samples of one machine."""

    def __init__(self, machine: str, way: Way, heaped: float) -> None:
        """`heaped`: what its bucket or vessel holds [m3], loose."""
        self._machine, self._way, self._heaped = machine, way, heaped
        self._state = State()
        self._restored = False  # and nothing was taken since

    @property
    def kind(self) -> Kind:
        """Of its cycles."""
        return self._way.kind

    @property
    def carries(self) -> bool:
        """Whether it carries soil from where it was filled to where it is poured."""
        return self._state.draft is not None and self._state.draft.part == self._way.carry

    @property
    def seen(self) -> float | None:
        """When it was looked at last [s since 1970]; None while no run holds it."""
        before = self._state.before
        return None if before is None or self._state.draft is None else before.time

    def state(self) -> dict[str, Any]:
        """Everything that it remembers, as JSON knows it."""
        return self._state.model_dump(mode="json")

    def restore(self, state: Any) -> None:
        """Go on from a kept state. Cycles that were told since get the same numbers again.

        Raises:
            ValueError: it is none; then nothing has changed.
        """
        self._state = State.model_validate(state)
        self._restored = True

    def forget(self) -> None:
        """Drop the cycle that is not over, as nobody knows what has become of the load; the next number stays."""
        self._state = State(numbers=self._state.numbers, first=self._state.first)

    def number_from(self, first: int) -> None:
        """Give the next cycle of every run this number: nobody knows which ones were used."""
        self._state = State(first=first)

    def take(self, now: Sample) -> list[Cycle]:
        """The cycles that have ended by a sample; one that is not newer than the last one changes nothing."""
        before = self._state.before
        if not all(map(math.isfinite, (now.time, *now.load, now.x, now.y, now.swing))):
            return []
        elapsed = math.inf if before is None else now.time - before.time
        if -GAP <= elapsed < STEP - 1e-6:
            return []
        self._state.before = now
        silent = self._restored and not 0.0 < elapsed <= LOST
        counted = before is not None and silent and not now.estimated and self._is_back(before, now)
        self._restored = False
        cycles = [] if before is None else self._end(before.time) if counted else self._through(before, now, elapsed)
        draft = self._state.draft
        if now.run and (draft is None or draft.run != now.run):
            sticks = now.load.loose <= REST * sum(one.loose for one in cycles)
            carries = self._loaded(now) and not counted and not sticks
            draft = self._begin(now.run, now, self._way.carry if carries else self._way.empty)
            if before is not None and before.run == now.run and elapsed > GAP:
                draft.begun, draft.unseen = before.time, elapsed
        return cycles

    def _is_back(self, before: Sample, now: Sample) -> bool:
        """Whether a load that was gone before a silence is there again."""
        return not now.measured and now.load.loose > before.load.loose + LEAST * self._heaped

    def _through(self, before: Sample, now: Sample, elapsed: float) -> list[Cycle]:
        """Go from one sample to the next, in the run that held the machine before."""
        if (draft := self._state.draft) is None:
            return []
        silent = not 0.0 < elapsed <= GAP
        seconds = GAP if silent else elapsed
        share = (now.load.loose - before.load.loose) / (self._heaped * seconds)
        if share > FLOWS and draft.poured is not None:
            cycles = self._end(before.time)
            draft = self._begin(before.run, before, self._way.fill)
        else:
            cycles = []
        self._soil(draft, before, now, share)
        if silent:
            return cycles + self._miss(draft, before, now, elapsed)
        draft.drive(before, now)
        draft.spend(seconds, now, self._way)
        if now.run != draft.run or self._is_out(draft, now, share):
            cycles += self._end(now.time)
            if now.run == draft.run:
                self._begin(now.run, now, self._way.empty)
        return cycles

    def _miss(self, draft: Draft, before: Sample, now: Sample, elapsed: float) -> list[Cycle]:
        """Go over a silence: what was poured ends with it; else the cycle goes on, and knows how long it missed."""
        if draft.poured is not None or now.run != draft.run or elapsed <= 0.0:
            return self._end(before.time)
        draft.miss(elapsed, now, self._way)
        return []

    def _soil(self, draft: Draft, before: Sample, now: Sample, share: float) -> None:
        """Find the part that it is in, and what went out; `share` of the heaped volume came in in a second."""
        way = self._way
        if self._comes(draft, now, share):
            draft.part = way.fill
            draft.fill(now)
        elif draft.part == way.empty:
            draft.low = min(draft.low, now.load.loose)
            draft.part = way.fill if now.cuts else way.empty
        elif draft.part == way.pour:
            draft.pour(before.load.less(now.load), before, now)
            if share < -FLOWS:
                draft.spot = now.x, now.y
            elif _goes(draft, now) and not self._is_out(draft, now, share):
                draft.part = way.carry
        elif not self._falls(draft, before, now, share) and _goes(draft, now):
            draft.part = way.carry if self._loaded(now) else way.empty

    def _comes(self, draft: Draft, now: Sample, share: float) -> bool:
        slowly = draft.part == self._way.empty and now.load.loose > draft.low + LEAST * self._heaped
        return share > FLOWS or slowly

    def _falls(self, draft: Draft, before: Sample, now: Sample, share: float) -> bool:
        """Whether the load is being poured out from now on."""
        way, under = self._way, now.under or before.under
        if share > -FLOWS or (way.falls_back and draft.part == way.fill and not under):
            draft.top = None
            return False
        draft.top = draft.top or before.load
        if not under and now.load.loose > (1 - SPILL) * draft.top.loose:
            return False
        draft.pour(draft.top.less(now.load), before, now)
        draft.part, draft.top, draft.spot = way.pour, None, (now.x, now.y)
        return True

    def _is_out(self, draft: Draft, now: Sample, share: float) -> bool:
        """Whether the load is out, but for what sticks."""
        if draft.poured is None:
            return False
        sticks = -share * self._heaped < STICKS * now.load.loose
        return now.load.loose <= 0.0 or (sticks and now.load.loose <= REST * draft.poured.loose)

    def _loaded(self, sample: Sample) -> bool:
        return sample.load.loose > LEAST * self._heaped

    def _begin(self, run: str, sample: Sample, part: str) -> Draft:
        self._state.draft = draft = Draft.begin(run, sample, part)
        return draft

    def _end(self, time: float) -> list[Cycle]:
        """End the cycle at a time [s since 1970]; it is one if something was poured."""
        draft, self._state.draft = self._state.draft, None
        if draft is None or draft.poured is None:
            return []
        numbers = self._state.numbers
        number = numbers.pop(draft.run, self._state.first - 1) + 1
        numbers[draft.run] = number  # the last one used is at the end
        if len(numbers) > RUNS:
            del numbers[next(iter(numbers))]
        return [draft.finished(self._machine, number, time, self._way, self._heaped)]


def _goes(draft: Draft, now: Sample) -> bool:
    """Whether it is leaving where soil last came in or went out."""
    drives = draft.spot is not None and math.dist(draft.spot, (now.x, now.y)) > LEAVES
    return drives or abs(now.swing) > SWINGS
