"""A cycle that is not over yet: what it has moved, and how long its parts took. Plain data that can be kept."""

import math
from datetime import datetime, timezone

from pydantic import BaseModel, ConfigDict, Field

from tms_work.cycle import Cycle
from tms_work.sample import Amount, Sample
from tms_work.ways import Way

PATIENCE = 3.0  # s; who stands for a shorter time is between two motions (planning, dead times) and does not wait
APART = 5.0  # s between two buckets into one carrier at least; the quickest excavators need 13 s for a cycle
DRIVES = 0.2  # m, what is less is noise of a pose
FASTEST = 10.0  # m/s; a machine that is faster was put somewhere else, or its pose found anew


class Draft(BaseModel):
    """One cycle of a run, from its beginning until now."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    run: str
    begun: float  # s since 1970
    part: str
    at: tuple[float, float]  # m, where the way driven is known up to
    parts: dict[str, float] = Field(default_factory=dict)  # s
    still: float = 0.0  # s that it has stood, which are in no part yet
    low: float  # m3, loose, the least that stuck in it while it was empty
    spot: tuple[float, float] | None = None  # m, where soil last came in or was poured
    filled: float | None = None  # s since 1970, when soil last came in
    fills: int = 0  # buckets that came in
    top: Amount | None = None  # load before soil began to fall out; it may be spilled, or poured
    falling: float = 0.0  # s since then, which are in no part yet
    poured: Amount | None = None
    into: dict[str, float] = Field(default_factory=dict)  # m3, loose, by carrier; empty: to the ground
    soil: str = ""
    measured: bool = False
    distance: float = 0.0  # m, driven
    unseen: float = 0.0  # s of silences, which are in no part

    @classmethod
    def begin(cls, run: str, sample: Sample, part: str) -> "Draft":
        """A cycle that begins at a sample."""
        return cls(run=run, begun=sample.time, part=part, at=(sample.x, sample.y), low=sample.load.loose)

    def fill(self, now: Sample) -> None:
        """Soil comes in."""
        if self.filled is None or now.time - self.filled > APART:
            self.fills += 1
        self.filled, self.spot, self.top = now.time, (now.x, now.y), None

    def pour(self, amount: Amount, before: Sample, now: Sample) -> None:
        """Soil goes to the carrier below, or to the ground."""
        self.poured = (self.poured or Amount()).more(amount)
        # The carrier may drive off as soon as the last soil is in.
        under = now.under or before.under
        self.into[under] = self.into.get(under, 0.0) + amount.loose
        self.soil, self.measured = before.soil or self.soil, before.measured

    def drive(self, before: Sample, now: Sample) -> None:
        """Add the way to where it is now."""
        here = now.x, now.y
        if math.dist((before.x, before.y), here) > FASTEST * (now.time - before.time):
            self.at = here
        elif (way := math.dist(self.at, here)) >= DRIVES:
            self.at, self.distance = here, self.distance + way

    def spend(self, seconds: float, now: Sample, way: Way) -> None:
        """Give the time [s] since the last sample to a part."""
        if self.top is not None and not now.stopped:
            self.falling += seconds
        elif not now.moves and not now.stopped and not now.under and self.part in way.waits:
            self.still += seconds
        else:
            self.settle(way)
            self._add("stopped" if now.stopped else self.part, seconds)

    def miss(self, seconds: float, now: Sample, way: Way) -> None:
        """Go over a silence [s], in which anything may have happened."""
        self.settle(way)
        self.top, self.at, self.unseen = None, (now.x, now.y), self.unseen + seconds

    def settle(self, way: Way) -> None:
        """Give the time that is in no part yet to one."""
        self._add(way.wait if self.still >= PATIENCE else self.part, self.still)
        self._add(self.part, self.falling)
        self.still = self.falling = 0.0

    def finished(self, machine: str, number: int, end: float, way: Way, heaped: float) -> Cycle:
        """The cycle, ended at a time [s since 1970], of a bucket or vessel that holds `heaped` m3."""
        self.settle(way)
        mass, bank, loose = (max(0.0, one) for one in self.poured or Amount())
        return Cycle(
            run_id=self.run, machine=machine, number=number, kind=way.kind, begun_at=_date(self.begun),
            ended_at=_date(end), parts=self.parts, soil=self.soil, bank=bank, loose=loose, mass=mass,
            fill=loose / heaped, distance=self.distance, unseen=self.unseen, measured=self.measured,
            into=max(self.into, key=lambda name: self.into[name], default=""),
            buckets=self.fills if way.kind == "haul" else 0,
        )  # fmt: skip

    def _add(self, part: str, seconds: float) -> None:
        if seconds > 0.0:
            self.parts[part] = self.parts.get(part, 0.0) + seconds


def _date(time: float) -> datetime:
    return datetime.fromtimestamp(time, timezone.utc)
