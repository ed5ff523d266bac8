"""What machines told while runs were active, as the API shows it."""

from typing import Literal

from pydantic import Field

from tms_ur.base_model import Model

SeriesKind = Literal["joints", "pose", "load"]


class Series(Model):
    """What one machine told."""

    machine: str
    kind: SeriesKind
    names: list[str] = Field(description="joints: rad; x and y in map: m, yaw: rad; mass: kg, bank and loose: m3")
    times: list[float] = Field(description="s since 1970, rising")
    values: list[list[float]] = Field(description="a list for each name, a value for each time")


class Recording(Model):
    """A time that was recorded; without series nothing of it is known."""

    series: list[Series] = Field(description="by machine")
