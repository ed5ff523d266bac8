"""Sums of cycles: of all, and by run, machine, hour or day. Each cycle counts where it ended."""

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from datetime import date, datetime, timedelta, tzinfo

from tms_work.cycle import Cycle


@dataclass(frozen=True)
class Sum:
    """What some cycles moved. Soil counts once, when it is dug; what carriers took away is told beside it."""

    cycles: int  # of excavators
    bank: float  # m3, dug, as the soil lay
    loose: float  # m3, dug, as it was carried
    mass: float  # kg, dug
    fill: float | None  # mean of the buckets whose fill is known
    loads: int  # of carriers
    hauled: float  # m3, loose, that carriers tipped
    distance: float  # m, driven by carriers
    digging: float  # s, of all excavators' cycles together, as far as they were seen
    unseen: float  # s of all cycles in which nobody looked: what was moved then is estimated, or missing
    parts: dict[str, float]  # s, of excavators' cycles
    haul_parts: dict[str, float]  # s, of carriers' cycles
    measured: int  # cycles of excavators whose volume a machine measured itself

    @property
    def rate(self) -> float | None:
        """Bank m3 in an hour of one excavator; None where nothing was dug."""
        return self.bank / self.digging * 3600 if self.digging > 0 else None

    @property
    def mean_cycle(self) -> float | None:
        """Mean length of an excavator's cycle [s]; None where there is none."""
        return self.digging / self.cycles if self.cycles else None


def total(cycles: Sequence[Cycle]) -> Sum:
    """The sum of cycles."""
    dug = [one for one in cycles if one.kind == "dig"]
    hauls = [one for one in cycles if one.kind == "haul"]
    fills = [one.fill for one in dug if one.fill is not None]
    return Sum(
        cycles=len(dug),
        bank=sum(one.bank for one in dug),
        loose=sum(one.loose for one in dug),
        mass=sum(one.mass for one in dug),
        fill=sum(fills) / len(fills) if fills else None,
        loads=sum(one.loose > 0 for one in hauls),
        hauled=sum(one.loose for one in hauls),
        distance=sum(one.distance for one in hauls),
        digging=sum(one.seconds - one.unseen for one in dug),
        unseen=sum(one.unseen for one in cycles),
        parts=_parts(dug),
        haul_parts=_parts(hauls),
        measured=sum(one.measured for one in dug),
    )


def by(cycles: Iterable[Cycle], key: Callable[[Cycle], str]) -> dict[str, Sum]:
    """Sums by a key, in its order."""
    groups: dict[str, list[Cycle]] = defaultdict(list)
    for one in cycles:
        groups[key(one)].append(one)
    return {name: total(groups[name]) for name in sorted(groups)}


def hour(zone: tzinfo | None) -> Callable[[Cycle], str]:
    """Key: the hour of a time zone in which a cycle ended, as 2026-11-26 13; None: that of this PC."""
    return lambda one: one.ended_at.astimezone(zone).strftime("%Y-%m-%d %H")


def day(zone: tzinfo | None) -> Callable[[Cycle], str]:
    """Key: the day of a time zone in which a cycle ended."""
    return lambda one: one.ended_at.astimezone(zone).strftime("%Y-%m-%d")


def span(day: date) -> tuple[datetime, datetime]:
    """Begin and end of a day in the time of this PC."""
    begin, end = (datetime(at.year, at.month, at.day).astimezone() for at in (day, day + timedelta(days=1)))
    return begin, end


def _parts(cycles: Iterable[Cycle]) -> dict[str, float]:
    found: Counter[str] = Counter()
    for one in cycles:
        found.update(one.parts)
    return dict(found)
