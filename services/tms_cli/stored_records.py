"""Functions for verbs about records: read from tms:db, write, load from a file, and show."""

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tms_cli import live, session
from tms_cli.reasons import BeforeThat
from tms_cli.words import say
from tms_config.clock import monotonic, sleep, unix_time
from tms_reason.errors import TmsError

if TYPE_CHECKING:
    from tms_msg_db.msg import Record as Message

    from tms_db.records import Record
    from tms_ros.node import Ros

WIDEST = 100  # letters of a document in a list
PATIENCE, PAUSE = 30.0, 0.5  # s that a load waits for a store that is away or stalls, and between two tries


def source() -> str:
    """The user of the command line, for the field `source` of records."""
    return f"cli {os.environ.get('USER', '')}".strip()


def records(node: "Ros", model: str = "") -> "list[Message]":
    """Stored records."""
    from tms_msg_db.srv import ListParameters

    return list(session.call(node, ListParameters, "/tms/db/list_parameters", model_name=model).records)


def write(
    node: "Ros", key: tuple[str, str], values: Mapping[str, Any], expected: Mapping[str, Any] | None = None, **more: Any
) -> bool:
    """Set fields of a record, if other fields have the expected values; returns whether the record was made."""
    from tms_msg_db.srv import SetParameter

    from tms_machine.values import to_parameters

    model, record = key
    answer = session.call(
        node, SetParameter, "/tms/db/set_parameter", model_name=model, record_name=record, source=source(),
        values=to_parameters(values), expected=to_parameters(expected or {}), **more,
    )  # fmt: skip
    return answer.created


def load_file(node: "Ros", file: Path) -> dict[str, list[str]]:
    """Load a file; returns the record names by their result.

    Raises:
        TmsError: the file is wrong (nothing is written), or a record was refused (reports the records before it).
    """
    from tms_db.records import read_file

    wanted = read_file(file)
    stored = {(record.model_name, record.record_name): record for record in records(node)}
    done: dict[str, list[str]] = {"created": [], "changed": [], "unchanged": []}
    for record in wanted:
        key = (record.model_name, record.record_name)
        if key in stored and _says(stored[key], record):
            done["unchanged"].append("/".join(key))
            continue
        try:
            created = _put(node, record)
        except TmsError as error:
            raise TmsError(BeforeThat(error.reason, summary(done)), error.code) from error
        done["created" if created else "changed"].append("/".join(key))
    return done


def _put(node: "Ros", record: "Record") -> bool:
    """Write a record whole; whether it was made. A store that is away is waited for: twice written is as good as once.

    Raises:
        TmsError: the record was refused, or the store stays away.
    """
    key = (record.model_name, record.record_name)
    more: dict[str, Any] = {"type": record.type, "description": record.description, "max_age": record.max_age}
    until = monotonic() + PATIENCE
    while True:
        try:
            return write(node, key, record.values, create=True, **more)
        except TmsError as error:
            if error.code != "STORE_DOWN" or monotonic() > until:
                raise
        sleep(PAUSE)


def _says(stored: "Message", wanted: "Record") -> bool:
    """Whether a stored record has all values of the file's record, with the same types."""
    from tms_machine.values import to_parameters

    there = {value.name: value.value for value in stored.values}
    return (
        stored.type == wanted.type
        and wanted.description in ("", stored.description)
        and wanted.max_age in (0.0, stored.max_age)
        and all(there.get(value.name) == value.value for value in to_parameters(wanted.values))
    )


def summary(done: Mapping[str, list[str]]) -> str:
    """The result of a load in one line."""
    return say("{created} created, {changed} changed, {unchanged} unchanged", **{k: len(v) for k, v in done.items()})


def title(record: "Message") -> str:
    """MODEL/RECORD of a stored record."""
    return f"{record.model_name}/{record.record_name}"


def as_dict(record: "Message") -> dict[str, Any]:
    """A record for --json."""
    from tms_machine.values import from_parameters

    updated = live.moment(record.updated_at)
    return {
        "model_name": record.model_name,
        "record_name": record.record_name,
        "type": record.type,
        "description": record.description,
        "source": record.source,
        "max_age": record.max_age or None,
        "updated_at": live.iso(record.updated_at),
        "age": round(unix_time() - updated.timestamp(), 3) if updated else None,
        "values": from_parameters(record.values),
    }


def age(record: "Message") -> str:
    """The age of a record's values as text."""
    updated = live.moment(record.updated_at)
    if updated is None:
        return say("age unknown")
    return say("{age} old", age=live.duration(max(0.0, unix_time() - updated.timestamp())))


def text(value: Any) -> str:
    """A value as people write it; documents are cut, `--json` has them whole."""
    if _document(value):
        whole = json.dumps(value)
        return whole if len(whole) <= WIDEST else f"{whole[: WIDEST - 3]}..."
    return str(value).lower() if isinstance(value, bool) else str(value)


def _document(value: Any) -> bool:
    return isinstance(value, dict) or (isinstance(value, list) and bool(value) and isinstance(value[0], dict))


def kind(value: Any) -> str:
    """The type of a value as text."""
    if isinstance(value, dict):
        return say("document")
    if isinstance(value, list):
        return say("{kind} array", kind=kind(value[0])) if value else say("empty array")
    if isinstance(value, bool):
        return say("true/false")
    if isinstance(value, int):
        return say("integer")
    return say("decimal") if isinstance(value, float) else say("text")
