"""Maps a message to new values of a record, or to the reason why not; a message is any object with fields."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tms_machine import stamps
from tms_machine.sensing import FieldRule, Input
from tms_reason.errors import TmsError
from tms_reason.validation import Wrong
from tms_sp.field_types import NAMES, PART, PLAIN, STAMPS, VALUES, Fields, FieldsOf, FieldTypes
from tms_sp.reasons import (
    ArrayOfTexts,
    AValue,
    NamesNoRecord,
    NoElement,
    NoMessageField,
    NothingAt,
    NoValueOf,
    NoValues,
    SizesDiffer,
    StampNotFinite,
    TextOrNumber,
    TimeOrSeconds,
    ValueNotFinite,
    ValueOutOfRange,
    ValueTooLarge,
    WrongSize,
)

Key = tuple[str, str]  # model, record
Getter = Callable[[Any], Any]
LARGEST = 2**63 - 1  # whole number that messages and the store can hold


class MessageRefused(TmsError):
    """A message that must not change a record; refusals are counted by their code."""


@dataclass(frozen=True)
class MappedValues:
    """The values of one message, and the record that they belong to."""

    key: Key
    values: dict[str, Any]
    keep: tuple[str, ...]
    stamp: float | None  # s, clock of the source


class Mapping:
    """Maps the messages of one input to readings."""

    def __init__(self, given: Input, fields: Fields, fields_of: FieldsOf) -> None:
        """`fields`: names and types of the message's fields; `fields_of`: those of the messages inside it.

        Raises:
            Wrong: names a field that the message does not have, or that a record cannot hold.
        """
        self._input = given
        types = FieldTypes(fields, fields_of)
        self._model, self._record = _name(given.model, fields), _name(given.record, fields)
        self._keep = field_getter(given.keep, fields) if given.keep else None
        stamp = stamp_path(given, fields)
        self._stamp = field_getter(stamp, fields) if stamp else None
        self.loose = not given.fields
        taken = {text[1:] for text in (given.model, given.record) if text.startswith("$")} | {given.keep, "header"}
        rules = given.fields or {name: FieldRule(path=name) for name in fields if name not in taken}
        self._rules = [(name, rule, field_getter(rule.path, fields)) for name, rule in rules.items()]
        self._check(types)

    def _check(self, types: FieldTypes) -> None:
        given = self._input
        for text in (given.model, given.record):
            if text.startswith("$"):
                types.check(text[1:], PLAIN, TextOrNumber())
        if given.keep:
            types.check(given.keep, NAMES, ArrayOfTexts())
        if given.stamp:
            types.check(given.stamp, STAMPS, TimeOrSeconds())
        for _, rule, _ in self._rules:
            types.check(rule.path, VALUES, AValue())

    def read(self, message: Any) -> MappedValues:
        """The values of a message.

        Raises:
            MessageRefused: with the reason.
        """
        key = self._model(message), self._record(message)
        if not key[1].strip():
            raise MessageRefused(NamesNoRecord())
        values = {name: self._value(name, rule, getter, message) for name, rule, getter in self._rules}
        self._check_sizes(values)
        keep = tuple(map(str, self._keep(message))) if self._keep else ()
        return MappedValues(key, values, keep, _seconds(self._stamp(message)) if self._stamp else None)

    def _value(self, name: str, rule: FieldRule, getter: Getter, message: Any) -> Any:
        value = getter(message)
        if isinstance(value, (bool, int, float, str)):
            return self._checked(name, _scaled(value, rule.factor))
        parts = value.tolist() if hasattr(value, "tolist") else value
        if not isinstance(parts, (list, tuple)) or not all(isinstance(one, (bool, int, float, str)) for one in parts):
            raise MessageRefused(NoValueOf(rule.path, type(value).__name__))
        if rule.size is not None and len(parts) != rule.size:
            raise MessageRefused(WrongSize(name, len(parts), rule.size))
        return [self._checked(name, _scaled(part, rule.factor)) for part in parts]

    def _checked(self, name: str, value: Any) -> Any:
        if isinstance(value, float) and not math.isfinite(value):
            raise MessageRefused(ValueNotFinite(name, str(value)))
        if isinstance(value, int) and value > LARGEST:  # possible in a uint64
            raise MessageRefused(ValueTooLarge(name, value, LARGEST))
        limits = self._input.range.get(name.lower() if self.loose else name)
        if limits is not None and not isinstance(value, str) and not limits[0] <= value <= limits[1]:
            raise MessageRefused(ValueOutOfRange(name, float(value), *map(float, limits)))
        return value

    def _check_sizes(self, values: dict[str, Any]) -> None:
        """Refuse arrays of different sizes: the n-th elements of x, y and z are one point."""
        sizes = {name: len(value) for name, value in values.items() if isinstance(value, list)}
        if len(set(sizes.values())) > 1:
            raise MessageRefused(SizesDiffer(tuple(f"{name} {size}" for name, size in sizes.items())))
        if 0 in sizes.values():
            raise MessageRefused(NoValues(tuple(sizes)))


def stamp_path(given: Input, fields: dict[str, str]) -> str | None:
    """The path of the time of measurement in an input's messages; None if they have none."""
    return given.stamp or ("header.stamp" if fields.get("header") == "std_msgs/Header" else None)


def _name(text: str, fields: dict[str, str]) -> Callable[[Any], str]:
    if not text.startswith("$"):
        return lambda _: text
    getter = field_getter(text[1:], fields)
    return lambda message: str(getter(message))


def field_getter(path: str, fields: dict[str, str]) -> Getter:
    """Make a function that reads a field by its path.

    Raises:
        Wrong: the message has no such field.
    """
    steps = [found.groups() for found in PART.finditer(path)]
    if steps[0][0] not in fields:
        raise Wrong(NoMessageField(steps[0][0], tuple(fields)))

    def get(message: Any) -> Any:
        found = message
        for name, index in steps:
            if not hasattr(found, name):
                raise MessageRefused(NothingAt(path, name))
            parent, found = found, getattr(found, name)
            if index is not None:
                found = _element(path, parent, found, index)
        return found

    return get


def _element(path: str, parent: Any, array: Any, index: str) -> Any:
    names = getattr(parent, "name", ())
    number = int(index) if index.isdecimal() else list(names).index(index) if index in names else -1
    if not 0 <= number < len(array):
        raise MessageRefused(NoElement(path, len(array)))
    value = array[number]
    return value.item() if hasattr(value, "item") else value


def _scaled(value: Any, factor: float) -> Any:
    return value if factor == 1.0 or isinstance(value, (bool, str)) else value * factor


def _seconds(stamp: Any) -> float:
    seconds = float(stamp) if isinstance(stamp, (int, float)) else stamps.seconds(stamp)
    if not math.isfinite(seconds):
        raise MessageRefused(StampNotFinite(str(seconds)))
    return seconds
