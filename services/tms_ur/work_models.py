"""What machines have moved on a day, as the API shows it."""

from datetime import date

from pydantic import Field

from tms_ur.base_model import Model
from tms_work.plan import Plan
from tms_work.sums import Sum


class WorkSum(Model):
    """What some cycles moved. Soil counts when it is dug; what carriers took away is told beside it."""

    name: str = Field(description="the machine, or the hour in the site's time; empty: all")
    cycles: int = Field(description="of excavators")
    bank: float = Field(description="m3, dug, as the soil lay")
    loose: float = Field(description="m3, dug, as it was carried")
    mass: float = Field(description="kg, dug")
    fill: float | None = Field(description="mean of the buckets, by their heaped capacity; null: unknown")
    loads: int = Field(description="of carriers")
    hauled: float = Field(description="m3, loose, that carriers tipped")
    distance: float = Field(description="m, driven by carriers")
    rate: float | None = Field(description="bank m3 in an hour of one excavator; null: nothing was dug")
    mean_cycle: float | None = Field(description="s, of excavators; null: none")
    unseen: float = Field(description="s in which nobody looked: what was moved then is estimated, or missing")
    parts: dict[str, float] = Field(description="s, of excavators' cycles and carriers' cycles, by their parts")


class Work(Model):
    """The work of a day."""

    day: date = Field(description="in the site's time")
    total: WorkSum
    machines: list[WorkSum]
    hours: list[WorkSum]
    plan: Plan | None = Field(description="`ground: {plan: ...}` of the site file")


def sum_of(name: str, one: Sum) -> WorkSum:
    """A sum under its name."""
    return WorkSum(
        name=name, cycles=one.cycles, bank=one.bank, loose=one.loose, mass=one.mass, fill=one.fill, loads=one.loads,
        hauled=one.hauled, distance=one.distance, rate=one.rate, mean_cycle=one.mean_cycle, unseen=one.unseen,
        parts={**one.parts, **one.haul_parts},
    )  # fmt: skip
