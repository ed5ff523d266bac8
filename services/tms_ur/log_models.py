"""Logs of several processes in one, as the API shows them."""

from datetime import datetime

from pydantic import Field

from tms_ur.base_model import Model
from tms_ur.reason_view import ReasonView


class LogLine(Model):
    """A line of a log."""

    time: datetime = Field(description="by the clock of the process's PC")
    process: str = Field(description="group:name")
    level: str = Field(description="INFO, WARNING, ERROR, ...; empty: the line does not say")
    text: str = Field(description="the line without its time, level and process")


class MissingLog(Model):
    """A log that could not be read."""

    process: str
    reason: ReasonView = Field(description="why")


class Logs(Model):
    """Lines in the order of their times."""

    lines: list[LogLine]
    cut: bool = Field(description="there are older lines that were asked for")
    short: list[str] = Field(description="processes of whose log only the end was read, which begins later than asked")
    missing: list[MissingLog] = Field(description="the others are told all the same")
