"""Checks what a parameter record may hold, and reads records from a file; uses no database."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tms_config.yaml_file import read_yaml
from tms_db.reasons import (
    BadFieldName,
    BadMaxAge,
    BadRecordName,
    BadType,
    CannotBeStored,
    DollarOrDot,
    ExponentIsText,
    HoldsControl,
    HoldsNul,
    InFilePlace,
    KeyIsNoText,
    MixedArray,
    NameEmpty,
    NoFieldName,
    NoFiniteNumber,
    NoKeysAndValues,
    NoRecordList,
    RecordFileLarge,
    RecordTwice,
    ReservedField,
    StaticWithAge,
    TooManyBits,
)
from tms_reason import names
from tms_reason.errors import DbError
from tms_reason.reason import Reason

Scalar = bool | int | float | str
Value = Scalar | Sequence[Scalar]
Document = dict[str, Any]

# Fields that describe a record; a reader of values never sees them. `timestamps` is the C++ system's.
RESERVED = frozenset(
    {"_id", "model_name", "record_name", "type", "description", "updated_at", "source", "max_age", "timestamps"}
)
TYPES = ("static", "dynamic")
MAX_FILE = 5 * 2**20
INT64 = 2**63
EXPONENT = re.compile(r"[-+]?\d+[eE][-+]?\d+")


@dataclass(frozen=True)
class Record:
    """A checked record from a file or a message."""

    model_name: str  # "" = shared by all machines
    record_name: str
    type: str
    description: str
    values: dict[str, Value]
    max_age: float = 0.0  # s; 0 = its values never get too old

    @property
    def name(self) -> str:
        return title(self.model_name, self.record_name)


def title(model_name: str, record_name: str) -> str:
    """The name of a record in texts."""
    return f"{model_name}/{record_name}"


def models_of(document: Document) -> list[str]:
    """The models of a record: the C++ system's version 6 has records that several machines share."""
    stored = document.get("model_name")
    return [str(model) for model in stored] if isinstance(stored, list) else [str(stored or "")]


def bad(what: Reason) -> DbError:
    """The error for a record, or a value of one, that is refused."""
    return DbError(what, "BAD_RECORD")


def check_key(model_name: str, record_name: str) -> None:
    """Refuse a key that no reader could ask for.

    Raises:
        DbError: BAD_RECORD.
    """
    if not record_name:
        raise bad(NameEmpty())
    for label, text in (("model_name", model_name), ("record_name", record_name)):
        if text and (why := names.name_flaw(text)) is not None:
            raise bad(BadRecordName(label, text[:40], why))


def check_type(where: str, type_: str) -> None:
    """Refuse a record type other than static and dynamic.

    Raises:
        DbError: BAD_RECORD.
    """
    if type_ not in TYPES:
        raise bad(BadType(where, type_))


def check_max_age(where: str, max_age: Any, type_: str = "") -> None:
    """Refuse an age limit that is no number of seconds, or that a static record cannot keep.

    Raises:
        DbError: BAD_RECORD.
    """
    if isinstance(max_age, bool) or not isinstance(max_age, (int, float)) or not math.isfinite(max_age):
        raise bad(BadMaxAge(where, repr(max_age)))
    if max_age > 0 and type_ == "static":
        raise bad(StaticWithAge(where))


def check_line(where: str, label: str, text: str) -> None:
    """Refuse a line for people that holds a control character.

    Raises:
        DbError: BAD_RECORD.
    """
    if (found := names.control_letter(text)) is not None:
        raise bad(HoldsControl(where, label, found))


def check_values(where: str, values: Mapping[str, Any]) -> None:
    """Refuse fields that could not be stored, or not be read back as they were.

    Raises:
        DbError: BAD_RECORD; names the field.
    """
    for name, value in values.items():
        check_field(where, name)
        many = isinstance(value, (list, tuple))
        for part in value if many else [value]:
            _check_scalar(f"{where}.{name}", part)
        if many and len({float if type(part) is int else type(part) for part in value}) > 1:
            raise bad(MixedArray(f"{where}.{name}"))


def check_field(where: str, name: Any) -> None:
    """Refuse a field name that is reserved or that the database would not take.

    Raises:
        DbError: BAD_RECORD.
    """
    if not isinstance(name, str) or not name.strip():
        raise bad(NoFieldName(where, repr(name)))
    if name in RESERVED:
        raise bad(ReservedField(where, name))
    if name.startswith("$") or "." in name:
        raise bad(DollarOrDot(where, name[:40]))
    if (why := names.name_flaw(name)) is not None:
        raise bad(BadFieldName(where, name[:40], why))


def _check_scalar(where: str, value: Any) -> None:
    if isinstance(value, (bool, str)):
        if isinstance(value, str) and "\0" in value:
            raise bad(HoldsNul(where))
    elif isinstance(value, int):
        if not -INT64 <= value < INT64:
            raise bad(TooManyBits(where, str(value)))
    elif isinstance(value, float):
        if not math.isfinite(value):
            raise bad(NoFiniteNumber(where, str(value)))
    else:
        raise bad(CannotBeStored(where, _kind(value)))


def _kind(value: Any) -> str:
    if value is None:
        return "an empty value"
    if isinstance(value, dict):
        return "a nested mapping"
    return "a nested array" if isinstance(value, (list, tuple)) else f"a {type(value).__name__}"


def read_file(path: Path) -> list[Record]:
    """Records of a configs/parameters file: a YAML list of flat mappings.

    Raises:
        ConfigError: it is no readable YAML.
        DbError: BAD_RECORD; names the file, the record and the field.
    """
    if path.is_file() and path.stat().st_size > MAX_FILE:
        raise bad(RecordFileLarge(str(path), MAX_FILE / 2**20))
    data = read_yaml(path)
    if not isinstance(data, list) or not data:
        raise bad(NoRecordList(str(path)))
    records = [_from_file(f"{path}, record {number}", entry) for number, entry in enumerate(data, 1)]
    seen: set[tuple[str, str]] = set()
    for record in records:
        key = (record.model_name, record.record_name)
        if key in seen:
            raise bad(RecordTwice(str(path), record.name))
        seen.add(key)
    return records


def _from_file(where: str, entry: Any) -> Record:
    if not isinstance(entry, dict):
        raise bad(NoKeysAndValues(where, _kind(entry)))
    head = {key: entry.get(key, "") for key in ("model_name", "record_name", "type", "description")}
    for key, value in head.items():
        if not isinstance(value, str):
            raise bad(KeyIsNoText(where, key, repr(value)))
    max_age = entry.get("max_age", 0.0)
    values = {key: value for key, value in entry.items() if key not in head and key != "max_age"}
    check_max_age(where, max_age, head["type"])
    record = Record(**head, values=values, max_age=float(max_age))
    try:
        check_key(record.model_name, record.record_name)
    except DbError as error:
        raise bad(InFilePlace(where, error.reason)) from error
    where = f"{where} ({record.name})"
    check_type(where, record.type)
    check_line(where, "description", record.description)
    check_values(where, record.values)
    for name, value in record.values.items():
        for part in value if isinstance(value, list) else [value]:
            if isinstance(part, str) and EXPONENT.fullmatch(part):  # YAML 1.1 wants a dot in it
                raise bad(ExponentIsText(f"{where}.{name}", part))
    return record
