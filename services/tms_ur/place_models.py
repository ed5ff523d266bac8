"""Shared places, as the API shows them."""

from datetime import datetime
from typing import Literal

from pydantic import Field

from tms_ur.base_model import Model
from tms_ur.reason_view import ReasonView

PlaceState = Literal["free", "granted", "held", "leaving", "revoked"]


class PlaceRequest(Model):
    """A machine waits for a shared place."""

    machine: str
    run: str = Field(description="empty: for a goal of the machine")
    since: datetime | None


class SharedPlace(Model):
    """A release area, which one machine holds at a time."""

    name: str
    state: PlaceState
    holder: str = Field(description="machine, empty if nobody holds it")
    run: str = Field(description="for which run, empty: the machine itself")
    since: datetime | None = Field(description="null: nobody holds it")
    queue: list[PlaceRequest] = Field(description="who waits, the next one first")
    reason: ReasonView | None = Field(description="why it is not given on")


class Revoked(Model):
    """Whose place was taken."""

    place: str
    holder: str


class SharedPlaces(Model):
    """All shared places, as tms:db told them last."""

    places: list[SharedPlace] = Field(default=[])
    alarms: list[ReasonView] = Field(default=[], description="machines that wait for each other in a circle")
