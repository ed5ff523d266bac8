"""Model of configs/sensing.yaml: inputs, each from a topic into parameter records."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, field_validator, model_validator

from tms_areas.trackers import Tracker
from tms_config.config import CONFIGS, Site
from tms_config.models import NAME, Settings
from tms_config.reasons import NoField, NotOrdered, NoUnit
from tms_config.yaml_file import parse
from tms_reason.names import Name, Text
from tms_reason.validation import Wrong

# Unit of a message -> factor to the unit that records use (m, rad, s, m/s, rad/s).
UNITS: Mapping[str, float] = {
    "deg": math.pi / 180, "deg/s": math.pi / 180, "mm": 0.001, "cm": 0.01, "km": 1000.0, "ms": 0.001, "us": 1e-6,
    "ns": 1e-9, "km/h": 1 / 3.6,
}  # fmt: skip
PATH = r"^[A-Za-z]\w*(\[[^\[\]]+\])?(\.[A-Za-z]\w*(\[[^\[\]]+\])?)*$"
Limits = tuple[float, float]


class FieldRule(Settings):
    """The source of one field of the record.

    `path` names a field of the message, through sub-messages (`pose.pose.position.x`), an element of an array
    (`data[0]`), or the element whose `name` beside it is the given one (`position[swing_joint]`).
    """

    path: str = Field(pattern=PATH)
    unit: str | None = None  # unit in the message; the record gets SI
    scale: float = 1.0
    size: int | None = Field(ge=1, default=None)  # number of elements that an array must have

    @field_validator("unit")
    @classmethod
    def _known(cls, unit: str | None) -> str | None:
        if unit is not None and unit not in UNITS:
            raise Wrong(NoUnit(unit, tuple(UNITS)))
        return unit

    @property
    def factor(self) -> float:
        return self.scale * (UNITS[self.unit] if self.unit else 1.0)


def _short(given: Any) -> Any:
    return {"path": given} if isinstance(given, str) else given


class Input(Settings):
    """One topic. A `model` or `record` that begins with $ names a field of the message; else it is the name itself."""

    topic: str = Field(pattern=r"^/?[A-Za-z][A-Za-z0-9_/]*$")
    type: str = Field(pattern=r"^[a-z][a-z0-9_]*/msg/[A-Z][A-Za-z0-9]*$")
    reliability: Literal["reliable", "best_effort"] = "reliable"
    depth: int = Field(ge=1, le=1000, default=500)  # half a second at the highest rate: a busy PC loses no message
    model: Text = "$model_name"  # "" = a record that all machines share
    record: Name = "$record_name"
    # Empty: every field of the message goes into the record's field of the same name in any case, if there is one.
    fields: dict[Name, Annotated[FieldRule, BeforeValidator(_short)]] = Field(default_factory=dict)
    range: dict[str, Limits] = Field(default_factory=dict)  # field (lower case without `fields`) -> least, most
    keep: str | None = None  # field of the message with a list of the record's fields that must stay
    only_if: dict[str, bool | int | float | str] = Field(default_factory=dict)  # fields that must hold these values
    stamp: str | None = None  # path of the time of measurement; a header's stamp needs no path
    hz: float = Field(ge=0, default=0.0)  # expected rate; 0: no rate is expected
    max_hz: float | None = Field(gt=0, default=None)  # faster messages of one record are left out

    @field_validator("range")
    @classmethod
    def _ordered(cls, ranges: dict[str, Limits]) -> dict[str, Limits]:
        for name, (least, most) in ranges.items():
            if not least < most:
                raise Wrong(NotOrdered(least, most), name)
        return ranges

    @model_validator(mode="after")
    def _ranges_of_fields(self) -> "Input":
        for name in self.range:
            if self.fields and name not in self.fields:
                raise Wrong(NoField(), "range", name)
        return self

    @property
    def fixed_target(self) -> tuple[str, str] | None:
        """Model and record, where neither comes from the message; else None."""
        return None if "$" in (self.model[:1], self.record[:1]) else (self.model, self.record)


class TerrainInput(Settings):
    """One topic with clouds of points in `map` (sensor_msgs/msg/PointCloud2), for the ground of the site."""

    topic: str = Field(pattern=r"^/?[A-Za-z][A-Za-z0-9_/]*$")
    reliability: Literal["reliable", "best_effort"] = "best_effort"
    cell: float = Field(ge=0.1, le=1, default=0.1)  # m, over which points are averaged
    hz: float = Field(ge=0, default=0.0)  # expected rate; 0: no rate is expected


class MachineState(Settings):
    """Pose and joints of the site's machines, for the collections machine_pose and machine_joints."""

    hz: float = Field(ge=0, le=10, default=1.0)  # 0: none


class SensingFile(Settings):
    """The content of sensing.yaml."""

    clock_limit: float = Field(gt=0, default=0.5)  # s that a source's clock may be ahead; later stamps are refused
    machine_state: MachineState = MachineState()
    inputs: dict[Annotated[str, Field(pattern=NAME)], Input] = Field(default_factory=dict)
    terrain: dict[Annotated[str, Field(pattern=NAME)], TerrainInput] = Field(default_factory=dict)
    trackers: dict[Annotated[str, Field(pattern=NAME)], Tracker] = Field(default_factory=dict)  # gateways hear them


def sensing_path(site: Site) -> Path:
    """The file of this site: `sensing:` of the site file, beside it, or configs/sensing.yaml."""
    return site.path.parent / site.file.sensing if site.file.sensing else CONFIGS / "sensing.yaml"


def load_sensing(site: Site) -> SensingFile:
    """The inputs of a site.

    Raises:
        ConfigError: names the file and the key.
    """
    return parse(sensing_path(site), SensingFile)
