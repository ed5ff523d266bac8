"""Converts the values of documents to ROS messages and back."""

from collections.abc import Iterable, Mapping
from datetime import datetime, timezone
from typing import Any

from builtin_interfaces.msg import Time
from rcl_interfaces.msg import Parameter

from tms_db.reasons import FieldTwice, NoValueGiven, NoZone
from tms_db.records import RESERVED, Value, bad
from tms_machine import values
from tms_reason.errors import DbError

LAST_SECOND = 2**31 - 1  # of builtin_interfaces/Time


def to_parameters(document: Mapping[str, Any], hidden: Iterable[str] = RESERVED) -> tuple[list[Parameter], list[str]]:
    """The document's values as messages, and the names of values that a message cannot hold (nested, binary, dates)."""
    hidden = frozenset(hidden)
    shown = {name: value for name, value in document.items() if name not in hidden}
    left_out = [name for name, value in shown.items() if not values.can_travel(value)]
    return values.to_parameters({name: shown[name] for name in shown if name not in left_out}), left_out


def from_parameters(where: str, parameters: Iterable[Parameter]) -> dict[str, Value]:
    """Values by name.

    Raises:
        DbError: BAD_RECORD; a value is not set or is bytes, or a name occurs twice.
    """
    found: dict[str, Value] = {}
    for parameter in parameters:
        name, value = parameter.name, values.from_value(parameter.value)
        if name in found:
            raise bad(FieldTwice(where, name))
        if value is None:
            raise bad(NoValueGiven(f"{where}.{name}"))
        found[name] = value
    return found


def to_time(moment: object) -> Time:
    """A stored date as Time; zero for anything else."""
    if not isinstance(moment, datetime):
        return Time()
    second = int(moment.replace(microsecond=0).timestamp())
    return Time(sec=min(max(second, 0), LAST_SECOND), nanosec=moment.microsecond * 1000)


def from_time(time: Time) -> datetime:
    """Time as a date; the store keeps milliseconds."""
    milliseconds = time.nanosec // 1_000_000
    return datetime.fromtimestamp(time.sec, timezone.utc).replace(microsecond=milliseconds * 1000)


def date_of(text: str) -> datetime:
    """A date as ISO 8601 with its zone.

    Raises:
        DbError: NO_ZONE; it is none, or has no zone.
    """
    try:
        found = datetime.fromisoformat(text)
    except ValueError as error:
        raise DbError(NoZone(text)) from error
    if found.tzinfo is None:
        raise DbError(NoZone(text))
    return found
