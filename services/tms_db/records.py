"""What a parameter record may hold, and reading records from a file; knows no database."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tms_config import names
from tms_config.yaml_file import read_yaml
from tms_reason.errors import DbError

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
    """A record from outside, checked."""

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
    """How messages name a record."""
    return f"record {model_name}/{record_name}" if model_name else f"shared record {record_name}"


def bad(message: str) -> DbError:
    return DbError(message, "BAD_RECORD")


def check_key(model_name: str, record_name: str) -> None:
    """Refuse a key that no reader could ask for.

    Raises:
        DbError: BAD_RECORD.
    """
    if not record_name:
        raise bad("record_name is empty: give the record a name")
    for label, text in (("model_name", model_name), ("record_name", record_name)):
        if text and (why := names.flaw(text)) is not None:
            raise bad(f"{label} {text[:40]!r} {why}: write a plain name")


def check_type(where: str, type_: str) -> None:
    """Refuse a record type other than static and dynamic.

    Raises:
        DbError: BAD_RECORD.
    """
    if type_ not in TYPES:
        raise bad(f"{where}: type is '{type_}': write static or dynamic")


def check_max_age(where: str, max_age: Any, type_: str = "") -> None:
    """Refuse an age limit that is no number of seconds, or that a static record cannot keep.

    Raises:
        DbError: BAD_RECORD.
    """
    if isinstance(max_age, bool) or not isinstance(max_age, (int, float)) or not math.isfinite(max_age):
        raise bad(f"{where}: max_age is {max_age!r}: write seconds, for example 2.0")
    if max_age > 0 and type_ == "static":
        raise bad(f"{where}: a static record cannot get too old: make it dynamic, or take max_age away")


def check_line(where: str, label: str, text: str) -> None:
    """Refuse a line for people that holds a control character.

    Raises:
        DbError: BAD_RECORD.
    """
    if (found := names.control(text)) is not None:
        raise bad(f"{where}: {label} holds {found}: remove it")


def check_values(where: str, values: Mapping[str, Any]) -> None:
    """Refuse fields that could not be stored, or not be read back as they were.

    Raises:
        DbError: BAD_RECORD; names the field.
    """
    for name, value in values.items():
        check_field(where, name)
        many = isinstance(value, (list, tuple))
        for part in value if many else [value]:
            _check_scalar(f"{where}, field {name}", part)
        if many and len({float if type(part) is int else type(part) for part in value}) > 1:
            raise bad(f"{where}, field {name}: the array mixes types: use numbers only, or one other type")


def check_field(where: str, name: Any) -> None:
    """Refuse a field name that is reserved or that the database would not take.

    Raises:
        DbError: BAD_RECORD.
    """
    if not isinstance(name, str) or not name.strip():
        raise bad(f"{where}: a field has no name or a name that is no text ({name!r}): write a name")
    if name in RESERVED:
        raise bad(f"{where}: field '{name}' is reserved: choose another name")
    if name.startswith("$") or "." in name:
        raise bad(f"{where}: field name {name[:40]!r} must not start with $ or hold dots: choose another name")
    if (why := names.flaw(name)) is not None:
        raise bad(f"{where}: field name {name[:40]!r} {why}: write a plain name")


def _check_scalar(where: str, value: Any) -> None:
    if isinstance(value, (bool, str)):
        if isinstance(value, str) and "\0" in value:
            raise bad(f"{where}: the text holds a NUL character: remove it")
    elif isinstance(value, int):
        if not -INT64 <= value < INT64:
            raise bad(f"{where}: {value} does not fit into 64 bits: write a smaller number")
    elif isinstance(value, float):
        if not math.isfinite(value):
            raise bad(f"{where}: {value} is not a finite number: write a number")
    else:
        raise bad(f"{where}: {_kind(value)} cannot be stored: use a number, true/false, text or an array of these")


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
        raise bad(f"{path}: is larger than {MAX_FILE // 2**20} MB: is this the right file?")
    data = read_yaml(path)
    if not isinstance(data, list) or not data:
        raise bad(f"{path}: must hold a list of records, each starting with '- record_name:'")
    records = [_from_file(f"{path}, record {number}", entry) for number, entry in enumerate(data, 1)]
    seen: set[tuple[str, str]] = set()
    for record in records:
        key = (record.model_name, record.record_name)
        if key in seen:
            raise bad(f"{path}: {record.name} is there twice: remove one")
        seen.add(key)
    return records


def _from_file(where: str, entry: Any) -> Record:
    if not isinstance(entry, dict):
        raise bad(f"{where}: must hold keys and values, not {_kind(entry)}")
    head = {key: entry.get(key, "") for key in ("model_name", "record_name", "type", "description")}
    for key, value in head.items():
        if not isinstance(value, str):
            raise bad(f"{where}: {key} is {value!r}, not text: put it in quotes")
    max_age = entry.get("max_age", 0.0)
    values = {key: value for key, value in entry.items() if key not in head and key != "max_age"}
    check_max_age(where, max_age, head["type"])
    record = Record(**head, values=values, max_age=float(max_age))
    try:
        check_key(record.model_name, record.record_name)
    except DbError as error:
        raise bad(f"{where}: {error}") from error
    where = f"{where} ({record.name})"
    check_type(where, record.type)
    check_line(where, "description", record.description)
    check_values(where, record.values)
    for name, value in record.values.items():
        for part in value if isinstance(value, list) else [value]:
            if isinstance(part, str) and EXPONENT.fullmatch(part):  # YAML 1.1 wants a dot in it
                raise bad(f"{where}, field {name}: YAML reads {part} as text: write it with a dot, like 1.0e-3")
    return record
