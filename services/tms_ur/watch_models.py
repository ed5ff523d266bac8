"""Areas, people and hardware, as the API shows them."""

from typing import Any, Literal

from pydantic import Field

from tms_ur.base_model import Model
from tms_ur.reason_view import ReasonView


class Spot(Model):
    """A place in `map`."""

    x: float = Field(description="m")
    y: float = Field(description="m")


class SeenBy(Model):
    """What a tracker of people, vehicles or a gate has told last."""

    tracker: str
    kind: Literal["person", "vehicle", "gate"]
    silent: bool = Field(description="it tells nothing, or nothing that can be used")
    opened: bool = Field(description="of a gate: somebody may pass")
    places: list[Spot] = Field(description="where somebody is; of a silent tracker, where somebody was")


class EnabledAreas(Model):
    """The areas that a person has enabled. They are no protective device."""

    id: str | None = Field(description="of the set; null: none is enabled")
    by: str = Field(default="", description="who enabled them")
    areas: dict[str, Any] = Field(default={}, description="GeoJSON, its coordinates in the frame `map`, m")


class AreaChange(Model):
    """What other areas would say of one area."""

    id: str
    kind: Literal["added", "removed", "changed"]
    before: float = Field(description="m2")
    after: float = Field(description="m2")
    away: float = Field(description="m2 that only the area before covers")
    new: float = Field(description="m2 that only the area after covers")


class AreasChecked(Model):
    """What it would mean to enable areas; nothing was enabled."""

    id: str = Field(description="of the set")
    changes: list[AreaChange] = Field(description="against what is enabled now")
    refusals: list[ReasonView] = Field(description="why machines would refuse it; empty: none would")


class Watched(Model):
    """What a gateway watches besides the motion of its machine."""

    people: ReasonView | None = Field(default=None, description="who is among the machines, or near; null: nobody")
    hardware: dict[str, str] = Field(default={}, description="what its hardware says: yes, no or unknown")
