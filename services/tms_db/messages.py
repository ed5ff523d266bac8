"""Tasks, records and history as ROS messages."""

from typing import Any

from tms_msg_db import msg

from tms_db.cycles import checked
from tms_db.history import Event, Run
from tms_db.machine_states import document_of, envelope
from tms_db.records import Document
from tms_db.tasks import Task
from tms_db.templates import Template
from tms_db.values import from_parameters, from_time, to_parameters, to_time
from tms_work.cycle import Cycle


def task(task: Task) -> msg.Task:
    """A stored task as a message."""
    return msg.Task(**{**vars(task), "added_at": to_time(task.added_at)})


def template(template: Template) -> msg.Template:
    """A stored template as a message."""
    texts = {"model_name": template.model_name, "description": template.description}
    return msg.Template(
        **texts, template_name=template.name, task_sequence=template.task_sequence, added_at=to_time(template.added_at)
    )


def record(document: Document) -> tuple[msg.Record, list[str]]:
    """The record as a message, and the names of fields that a message cannot hold."""
    values, left_out = to_parameters(document)
    heads = ("model_name", "record_name", "type", "description", "source")
    texts = {key: str(document.get(key) or "") for key in heads}
    limit = document.get("max_age")
    max_age = float(limit) if isinstance(limit, (int, float)) else 0.0
    return msg.Record(**texts, updated_at=to_time(document.get("updated_at")), max_age=max_age, values=values), left_out


def run(run: Run) -> msg.Run:
    """A stored run as a message."""
    times = {"started_at": to_time(run.started_at), "ended_at": to_time(run.ended_at)}
    lists = {"machines": list(run.machines), "records": list(run.records)}
    values, _ = to_parameters(run.values, hidden=())
    return msg.Run(**{**vars(run), **lists, **times, "values": values})


def stored_run(message: msg.Run) -> Run:
    """A message as the run to store."""
    ended = message.ended_at
    return Run(
        run_id=message.run_id,
        task_id=message.task_id,
        description=message.description,
        state=message.state,
        reason=message.reason,
        machines=tuple(message.machines),
        records=tuple(message.records),
        started_at=from_time(message.started_at),
        ended_at=from_time(ended) if ended.sec or ended.nanosec else None,
        values=from_parameters(f"run {message.run_id}", message.values),
    )


def event(event: Event) -> msg.Event:
    """A stored event as a message."""
    values, _ = to_parameters(event.values, hidden=())
    return msg.Event(**{**vars(event), "stamp": to_time(event.stamp), "values": values})


def stored_event(message: msg.Event) -> Event:
    """A message as the event to store."""
    return Event(
        run_id=message.run_id,
        number=message.number,
        stamp=from_time(message.stamp),
        kind=message.kind,
        node=message.node,
        text=message.text,
        values=from_parameters(f"event {message.number} of run {message.run_id}", message.values),
    )


def past(change: dict[str, Any]) -> msg.PastValues:
    """One change of a record as a message."""
    values, _ = to_parameters(change["values"], hidden=())
    return msg.PastValues(stamp=to_time(change["stamp"]), source=change["source"], values=values)


def cycle(message: msg.MachineState) -> Cycle:
    """A finished cycle of work.

    Raises:
        DbError: BAD_RECORD, BAD_CYCLE; names the field.
    """
    return checked(document_of(message.collection, message.machine, message.msg))


def machine_state(message: msg.MachineState) -> Document:
    """A state in the form of the C++ system's collections.

    Raises:
        DbError: BAD_RECORD; it is no JSON object.
    """
    return envelope(message.collection, message.machine, from_time(message.stamp), message.msg)
