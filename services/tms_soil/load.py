"""What a bucket or a vessel holds, as people count it."""

from dataclasses import dataclass
from typing import Protocol

from tms_soil.grid import Grid
from tms_soil.surface import Array


class Vessel(Protocol):
    """A bucket or a vessel."""

    load: Array  # kg by soil

    @property
    def capacity(self) -> float:
        """What it holds at most, loose [m3]."""


@dataclass(frozen=True)
class Load:
    """Soil in a bucket or a vessel."""

    kind: int | None  # index of the grid's soils, that of the most mass; None: it is empty
    mass: float  # kg
    loose: float  # m3 as it is carried
    bank: float  # m3 as it lay
    capacity: float  # m3, loose, that it holds at most


def load_of(part: Vessel, grid: Grid) -> Load:
    """The load of a bucket or a vessel that works on a ground."""
    by_soil = part.load
    bank = sum(float(mass) / soil.bank for mass, soil in zip(by_soil, grid.soils, strict=True))
    mass = float(by_soil.sum())
    return Load(int(by_soil.argmax()) if mass else None, mass, float((by_soil / grid.loose).sum()), bank, part.capacity)
