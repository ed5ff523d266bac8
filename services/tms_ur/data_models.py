"""Models of the API's answers and commands about parameter records and sensing inputs."""

from datetime import datetime
from typing import Literal

from pydantic import Field

from tms_reason.names import Name
from tms_ur.base_model import Model
from tms_ur.command_models import Command
from tms_ur.models import Plain, Value
from tms_ur.reason_view import ReasonView


class Record(Model):
    """A parameter record; values keep their types."""

    model_name: str = Field(description="empty for records that all machines share")
    record_name: str
    type: str = Field(description="static or dynamic")
    description: str
    source: str = Field(description="who wrote it last")
    updated_at: datetime | None = None
    values: dict[str, Value | None] = Field(default={}, description="null: not a number, or infinite")
    types: dict[str, str] = Field(default={}, description="of each value: JSON does not tell 3 from 3.0")
    units: dict[str, str] = Field(default={}, description="of the fields that have one: m, rad, deg")


class Change(Model):
    """What one change of a record wrote."""

    stamp: datetime | None = None
    source: str
    values: dict[str, Value | None] = Field(description="null: not a number, or infinite")


class SensingInput(Model):
    """One declared input, counted since `tms:sp` started."""

    name: str
    topic: str
    state: str = Field(description="waiting (nothing came yet), alive, silent, clock (its PC's clock is off)")
    hz: float = Field(description="1/s, of the last seconds")
    hz_expected: float | None = Field(description="1/s; null: it comes when it comes")
    age: float | None = Field(description="s since the last accepted message, null: none yet")
    accepted: int
    refused: int
    last_refusal: ReasonView | None = Field(description="why, null: none yet")
    records: list[str] = Field(description="written so far")


class Sensing(Model):
    """The inputs of sensing, and how old this report is."""

    age: float | None = Field(description="s since `tms:sp` last reported, null: never; it reports every second")
    inputs: list[SensingInput]


class FieldGiven(Command):
    """A value with its type."""

    name: Name
    type: Literal["bool", "int", "double", "string", "bool[]", "int[]", "double[]", "string[]"]
    value: Plain


class RecordGiven(Command):
    """Fields to set, in one atomic step; the others stay."""

    model_name: str = Field(pattern=r"^[0-9A-Za-z_]{0,64}$")
    record_name: Name
    fields: list[FieldGiven] = Field(max_length=200)
    create: bool = False
    type: Literal["", "static", "dynamic"] = Field(default="", description="of a new record; empty keeps it")
