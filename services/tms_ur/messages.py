"""ROS messages as the API's models."""

from datetime import datetime, timezone
from typing import Any

from builtin_interfaces.msg import Time
from rcl_interfaces.msg import ParameterType
from tms_msg_areas import msg as areas
from tms_msg_db import msg as db
from tms_msg_ground import msg as ground
from tms_msg_host import msg as host
from tms_msg_rc import msg as rc
from tms_msg_sp import msg as sp
from tms_msg_ts import msg as ts

from tms_hardware.lamp import mode
from tms_machine import stamps
from tms_machine.values import from_parameters
from tms_reason import wire
from tms_reason.reason import Foreign
from tms_reason.units import unit
from tms_ur.data_models import Change, Record, SensingInput
from tms_ur.models import ActiveRun, Event, Joint, LastStop, Load, Machine, Process, Question, Receipt, Run, Template
from tms_ur.models import MachineState as Shown
from tms_ur.place_models import PlaceRequest, PlaceState, SharedPlace, SharedPlaces
from tms_ur.reason_view import ReasonView, of_line, view

NEVER = 1e8  # s, a larger age means that nothing was received yet
TYPES = {
    ParameterType.PARAMETER_BOOL: "bool", ParameterType.PARAMETER_INTEGER: "int",
    ParameterType.PARAMETER_DOUBLE: "double", ParameterType.PARAMETER_STRING: "string",
    ParameterType.PARAMETER_BOOL_ARRAY: "bool[]", ParameterType.PARAMETER_INTEGER_ARRAY: "int[]",
    ParameterType.PARAMETER_DOUBLE_ARRAY: "double[]", ParameterType.PARAMETER_STRING_ARRAY: "string[]",
    ParameterType.PARAMETER_BYTE_ARRAY: "document",
}  # fmt: skip


PLACE_STATES: tuple[PlaceState, ...] = (
    "free",
    "granted",
    "held",
    "leaving",
    "revoked",
)  # by number


def shared_places(told: areas.Places) -> SharedPlaces:
    """All shared places."""
    alarms = list(filter(None, map(of_line, told.alarms)))
    return SharedPlaces(places=list(map(_shared_place, told.places)), alarms=alarms)


def _shared_place(told: areas.Place) -> SharedPlace:
    queue = [PlaceRequest(machine=one.machine, run=one.run, since=when(one.since)) for one in told.queue]
    return SharedPlace(
        name=told.name, state=PLACE_STATES[told.state], holder=told.holder, run=told.run, since=when(told.since),
        queue=queue, reason=of_line(told.reason),
    )  # fmt: skip


def when(stamp: Time) -> datetime | None:
    """A time as a date; None for zero, which means never."""
    if not stamp.sec and not stamp.nanosec:
        return None
    return datetime.fromtimestamp(stamps.seconds(stamp), timezone.utc)


def machine(message: rc.MachineState) -> Machine:
    """For the console: the state of a machine."""
    joints = zip(message.joint_names, message.positions, message.velocities, strict=False)
    state: Shown = "not_ready" if not message.ready else "moving" if message.moving else "standing"
    return Machine(
        name=message.machine, state=state, reason=of_line(message.reason), goal=message.goal, owner=message.owner,
        joints=[Joint(name=name, position=round(p, 4), velocity=round(v, 4)) for name, p, v in joints],
        joint_age=message.age if message.age < NEVER else None,
        armed=message.armed, latch=of_line(message.latch), hold=of_line(message.hold), by_hand=message.by_hand,
        lamp=mode(bool(message.by_hand), message.armed, message.ready),
    )  # fmt: skip


def active_run(run: ts.RunState) -> ActiveRun:
    """For the console: a run that is active."""
    return ActiveRun(
        run_id=run.run_id, task_id=run.task_id, state=run.state, machines=list(run.machines),
        reason=of_line(run.reason), started_at=when(run.started_at), leaf=run.leaf, nodes="".join(map(str, run.nodes)),
    )  # fmt: skip


def question(asked: ts.Question) -> Question:
    """For the console: a question that waits for an answer."""
    return Question(
        id=asked.id, run_id=asked.run_id, node=asked.node, title=asked.title, text=asked.text,
        asked_at=when(asked.asked_at), until=when(asked.until),
    )  # fmt: skip


def receipt(made: rc.StopReceipt) -> Receipt:
    """For the console: a receipt of a stop."""
    return Receipt(
        machine=made.machine, confirmed=made.confirmed, seconds=round(made.seconds, 3),
        travel_joint=made.travel_joint, travel_rad=round(made.travel_rad, 4), travel_m=round(made.travel_m, 3),
        cause=of_line(made.cause), detail=of_line(made.detail), evidence=of_line(made.evidence), latched=made.latched,
    )  # fmt: skip


def last_stop(made: rc.StopReceipt) -> LastStop:
    """For the console: what a card tells of the last stop of a machine."""
    return LastStop(stamp=when(made.stamp), confirmed=made.confirmed)


def load(told: ground.SoilLoad) -> Load:
    """For the console: what a machine carries, no finer than a card shows it."""
    return Load(
        mass=round(told.mass, -1), loose=round(told.loose, 2), capacity=round(told.capacity, 2), measured=told.measured
    )


def process(row: host.Process, on_demand: bool) -> Process:
    """For the console: a supervised process."""
    return Process(
        name=row.name,
        state=row.state,
        pid=row.pid,
        restarts=row.restarts,
        uptime=row.uptime,
        detail=of_line(row.detail),
        cpu=round(row.cpu, 1),
        memory=row.memory,
        on_demand=on_demand,
    )


def task(task: db.Task) -> dict[str, Any]:
    """For the console: a stored task without its XML."""
    return {"id": task.task_id, "model_name": task.model_name, "description": task.description,
            "added_at": when(task.added_at)}  # fmt: skip


def template(template: db.Template) -> Template:
    """For the console: a stored template without its XML."""
    return Template(
        name=template.template_name, model_name=template.model_name, description=template.description,
        added_at=when(template.added_at),
    )  # fmt: skip


def run(run: db.Run) -> Run:
    """For the console: a run of the history."""
    return Run(
        run_id=run.run_id, task_id=run.task_id, description=run.description, state=run.state,
        reason=of_line(run.reason), machines=list(run.machines), started_at=when(run.started_at),
        ended_at=when(run.ended_at), values={**from_parameters(run.values)},
    )  # fmt: skip


def event(event: db.Event) -> Event:
    """For the console: an event of the history."""
    return Event(
        number=event.number, stamp=when(event.stamp), kind=event.kind, node=event.node, text=event.text,
        reason=_reason_in(event.text), values={**from_parameters(event.values)},
    )  # fmt: skip


def _reason_in(text: str) -> ReasonView | None:
    """The reason in a journal's text; None for plain text, which is shown as it is."""
    reason = wire.of(text)
    return None if reason is None or reason == Foreign(text) else view(reason)


def record(record: db.Record) -> Record:
    """For the console: a parameter record."""
    return Record(
        model_name=record.model_name, record_name=record.record_name, type=record.type,
        description=record.description, source=record.source, updated_at=when(record.updated_at),
        values={**from_parameters(record.values)},
        types={one.name: TYPES[one.value.type] for one in record.values if one.value.type in TYPES},
        units={one.name: unit(one.name) for one in record.values if unit(one.name)},
    )  # fmt: skip


def change(made: db.PastValues) -> Change:
    """For the console: a change of a record."""
    return Change(stamp=when(made.stamp), source=made.source, values={**from_parameters(made.values)})


def sensing_input(report: sp.InputState, since: float) -> SensingInput:
    """An input as `tms:sp` reported it `since` seconds ago."""
    return SensingInput(
        name=report.name, topic=report.topic, state=report.state, hz=round(report.hz, 2),
        hz_expected=report.hz_expected or None, age=round(report.age + since, 1) if report.age >= 0 else None,
        accepted=report.accepted, refused=report.refused,
        last_refusal=of_line(report.last_refusal), records=list(report.records),
    )  # fmt: skip
