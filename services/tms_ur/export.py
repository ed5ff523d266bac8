"""The journal of a run as a file: JSON for programs, CSV for tables, MCAP for the tools of robotics."""

import csv
import io
import json
from collections.abc import Callable

from tms_ur.models import Event

TYPES = {"json": "application/json", "csv": "text/csv", "mcap": "application/octet-stream"}
COLUMNS = ("number", "stamp", "kind", "node", "text")


def as_json(run_id: str, events: list[Event]) -> bytes:
    """A run with its events as one JSON document."""
    return json.dumps(
        {"run_id": run_id, "events": [event.model_dump(mode="json") for event in events]}, ensure_ascii=False, indent=1
    ).encode()


def as_csv(run_id: str, events: list[Event]) -> bytes:
    """A table of the events with a byte order mark, so that Excel reads Japanese; reasons as their English text."""
    out = io.StringIO()
    rows = csv.writer(out)
    rows.writerow(("run_id", *COLUMNS))
    for event in events:
        facts = event.model_dump(mode="json", include=set(COLUMNS))
        if event.reason is not None:
            facts["text"] = event.reason.text.en
        rows.writerow((run_id, *(_harmless(facts[column]) for column in COLUMNS)))
    return out.getvalue().encode("utf-8-sig")


def _harmless(cell: object) -> object:
    """Mark a text as text that a table program would take for a formula."""
    return f"'{cell}" if isinstance(cell, str) and cell.startswith(("=", "+", "-", "@", "\t")) else cell


def as_mcap(run_id: str, events: list[Event]) -> bytes:
    """An MCAP file with one channel `/tms/events` of JSON messages."""
    from mcap.writer import CompressionType, Writer  # loaded for an export only

    out = io.BytesIO()
    writer = Writer(out, compression=CompressionType.NONE)
    writer.start(profile="", library="ros2-tms")
    schema = {"type": "object", "properties": {name: {} for name in Event.model_fields}}
    number = writer.register_schema("tms.Event", "jsonschema", json.dumps(schema).encode())
    channel = writer.register_channel("/tms/events", "json", number, {"run_id": run_id})
    for event in events:
        stamp = int(event.stamp.timestamp() * 1e9) if event.stamp else 0
        writer.add_message(channel, stamp, event.model_dump_json().encode(), stamp, event.number)
    writer.finish()
    return out.getvalue()


FORMS: dict[str, Callable[[str, list[Event]], bytes]] = {"json": as_json, "csv": as_csv, "mcap": as_mcap}
