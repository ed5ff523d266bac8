"""Kinds of soil: configs/soils.yaml.

Soil has three states: bank (as it grew), loose (dug) and compacted. The volume of a mass follows from its state.
"""

import math

from pydantic import Field

from tms_config.models import Settings


class Soil(Settings):
    """One kind of soil. Angles are in degrees, as in tables of soils."""

    bank: float = Field(gt=0)  # kg/m3 in place
    swell: float = Field(ge=1)  # loose volume / bank volume, L of the Japanese standard rates
    compaction: float = Field(gt=0)  # compacted volume / bank volume, C of the Japanese standard rates
    repose: float = Field(gt=0, lt=60)  # deg, slope of a pile
    face: float = Field(gt=0, lt=90)  # deg, slope of a cut face that stands
    cohesion: float = Field(ge=0)  # Pa
    friction: float = Field(gt=0, lt=60)  # deg, inside the soil
    steel: float = Field(gt=0, lt=60)  # deg, friction against a blade
    fill: float = Field(gt=0, le=1.2)  # share of a bucket's heaped volume that digging fills
    origin: str = Field(min_length=1)  # where the figures come from

    @property
    def loose(self) -> float:
        """Density when dug [kg/m3]."""
        return self.bank / self.swell

    @property
    def compacted(self) -> float:
        """Density under tracks [kg/m3]."""
        return self.bank / self.compaction

    @property
    def repose_slope(self) -> float:
        """Rise by run of a pile."""
        return math.tan(math.radians(self.repose))

    @property
    def face_slope(self) -> float:
        """Rise by run of a cut face."""
        return math.tan(math.radians(self.face))


class SoilsFile(Settings):
    """The content of configs/soils.yaml."""

    soils: dict[str, Soil] = Field(min_length=1)
