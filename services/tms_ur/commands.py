"""Endpoints that change something: each names the role that it needs, and each is audited."""

import math
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, Any

import anyio
import anyio.to_thread
import structlog
from fastapi import FastAPI, Path, Request

from tms_config.config import Site
from tms_config.reasons import NoMachine
from tms_decision.reasons import SoftwareStopBy
from tms_reason.errors import TmsError
from tms_reason.reason import Reason
from tms_ur.access import Person
from tms_ur.angle_limits import check_angles
from tms_ur.command_models import (
    AnswerGiven,
    AreasGiven,
    AreasWanted,
    Nothing,
    RearmAsked,
    StartRun,
    StopAsked,
    TaskGiven,
    TemplateGiven,
)
from tms_ur.data_models import FieldGiven, RecordGiven
from tms_ur.models import Added, AddedTemplate, Rearmed, Receipt, RunAsked
from tms_ur.place_models import Revoked
from tms_ur.problems import Admin, Operator, Viewer, problems
from tms_ur.reading import MachineName, PlaceName, ProcessName, RunId, TaskId
from tms_ur.reasons import BadValue, IntTooLong, NotFinite, NotOfType, NotUnicode, Starting
from tms_ur.security import source
from tms_ur.watch_models import AreasChecked

if TYPE_CHECKING:
    from tms_ur.audit import Audit
    from tms_ur.site_client import SiteClient

ANSWERS = problems(403, 404, 409, 411, 413, 415, 503)
STOPS = 40  # stops at the same time, each with a thread a machine, so that they do not wait for other workers
CANCELS = 10  # runs that are cancelled at the same time
KEPT_LIMIT = 1.0  # s that a command waits for its entry to be on the disk
QuestionId = Annotated[str, Path(pattern=r"^[0-9A-Za-z_-]{1,100}$")]
log = structlog.stdlib.get_logger(__name__)


def add(app: FastAPI, client: "SiteClient", audit: "Audit", site: Site) -> None:
    """Add these endpoints to the application."""
    note = _Note(audit)
    _runs(app, client, note)
    _machines(app, client, note, site)
    _stored(app, client, note, site)
    _places(app, client, note)
    _areas(app, client, note)
    _processes(app, client, note)
    _interrupted(app, client, note)


class _Note:
    """Audits the command of a request."""

    def __init__(self, audit: "Audit") -> None:
        self._audit = audit

    def __call__(self, request: Request, person: Person, what: str, target: object) -> str:
        """Audit a command and wait until the entry is on the disk. Not on the event loop."""
        where = source(request.scope)
        if not self._audit.put(person.name, where, what, str(target)).wait(KEPT_LIMIT):
            log.warning("audit_late", what=what, reason="the disk is slow; the command is in the log")
        return f"{person.name} at {where}"

    def of_stop(self, request: Request, person: Person, what: str, target: str) -> str:
        """Audit a stop, which does not wait for the disk."""
        where = source(request.scope)
        self._audit.put(person.name, where, what, target)
        return f"{person.name} at {where}"


def _runs(app: FastAPI, client: "SiteClient", note: _Note) -> None:
    starting = _Once()
    cancels = anyio.CapacityLimiter(CANCELS)

    @app.post("/api/runs", status_code=202, summary="Run a task; answers when it has begun", responses=ANSWERS)
    def start_run(request: Request, wanted: StartRun, person: Operator) -> RunAsked:
        note(request, person, "start_run", f"task {wanted.task_id}")
        with starting.only(wanted.task_id):
            return RunAsked(run_id=client.start_run(wanted.task_id, wanted.ignore_warnings))

    @app.post("/api/runs/{run_id}/cancel", status_code=202, summary="Ask a run to stop", responses=ANSWERS)
    async def cancel_run(request: Request, run_id: RunId, _: Nothing, person: Operator) -> RunAsked:
        note.of_stop(request, person, "cancel_run", run_id)
        await anyio.to_thread.run_sync(client.cancel_run, run_id, limiter=cancels)
        return RunAsked(run_id=run_id)

    @app.post("/api/questions/{question_id}", summary="Answer a question of a run; the first answer counts",
              responses=ANSWERS)  # fmt: skip
    def answer(request: Request, question_id: QuestionId, given: AnswerGiven, person: Operator) -> AnswerGiven:
        who = note(request, person, "answer", f"{question_id} {'yes' if given.yes else 'no'}")
        client.answer(question_id, given.yes, who)
        return given


class _Once:
    """Allows one start of a task at a time, so that a double click starts one run."""

    def __init__(self) -> None:
        self._open: set[int] = set()
        self._lock = threading.Lock()

    @contextmanager
    def only(self, task_id: int) -> Iterator[None]:
        with self._lock:
            if task_id in self._open:
                raise TmsError(Starting(task_id))
            self._open.add(task_id)
        try:
            yield
        finally:
            with self._lock:
                self._open.discard(task_id)


def _machines(app: FastAPI, client: "SiteClient", note: _Note, site: Site) -> None:
    names = list(site.file.machines)
    stops = anyio.CapacityLimiter(STOPS)

    @app.post("/api/stop", summary="Software stop of all machines or of one; answers when they stand",
              responses=problems(403, 404, 411, 413, 415))  # fmt: skip
    async def stop(request: Request, asked: StopAsked, person: Viewer) -> list[Receipt]:
        machines = [_known(asked.machine, names)] if asked.machine else names
        who = note.of_stop(request, person, "stop", asked.machine or "all machines")
        return await anyio.to_thread.run_sync(client.stop, machines, SoftwareStopBy(who), limiter=stops)

    @app.post("/api/machines/{name}/rearm", summary="Re-arm a stopped machine, in two steps", responses=ANSWERS)
    def rearm(
        request: Request, name: MachineName, asked: RearmAsked, person: Operator
    ) -> Rearmed:  # fmt: skip
        note(request, person, "rearm" if asked.token else "rearm_asked", _known(name, names))
        return client.rearm(name, asked.token)

    @app.post("/api/machines/{name}/escape", summary="Let a machine that stands outside its areas back in, slowly",
              responses=ANSWERS)  # fmt: skip
    def escape(request: Request, name: MachineName, _: Nothing, person: Operator) -> Nothing:
        client.let_back(name, note(request, person, "escape_asked", _known(name, names)))
        return Nothing()

    @app.post("/api/machines/{name}/give-back", summary="End driving by hand; answers when the machine stands",
              responses=ANSWERS)  # fmt: skip
    def give_back(request: Request, name: MachineName, _: Nothing, person: Operator) -> Receipt:
        return client.give_back(name, note(request, person, "give_back", _known(name, names)))


def _known(machine: str, names: list[str]) -> str:
    if machine not in names:
        raise TmsError(NoMachine(machine, tuple(names)))
    return machine


def _stored(app: FastAPI, client: "SiteClient", note: _Note, site: Site) -> None:
    @app.post("/api/tasks", status_code=201, summary="Store a tree as a task", responses=ANSWERS)
    def add_task(request: Request, given: TaskGiven, person: Admin) -> Added:
        number, there = client.add_task(given.xml, given.description)
        note(request, person, "add_task", f"task {number}")
        return Added(id=number, already_stored=there)

    @app.post("/api/tasks/{task_id}/remove", summary="Take a task out; its number becomes free", responses=ANSWERS)
    def remove_task(request: Request, task_id: TaskId, _: Nothing, person: Admin) -> Nothing:
        note(request, person, "remove_task", f"task {task_id}")
        client.remove_task(task_id)
        return Nothing()

    @app.post("/api/templates", status_code=201, summary="Store a tree as a template", responses=ANSWERS)
    def add_template(request: Request, given: TemplateGiven, person: Admin) -> AddedTemplate:
        note(request, person, "add_template", given.name)
        return client.add_template(given.name, given.xml, given.description, given.replace)

    @app.post("/api/parameters", summary="Set fields of a record in one step", responses=ANSWERS)
    def set_parameter(request: Request, given: RecordGiven, person: Admin) -> Nothing:
        values = {field.name: _typed(field) for field in given.fields}
        if given.model_name in site.file.machines:
            check_angles(site.model_of(given.model_name), values)
        reported = ", ".join(f"{name}={value}" for name, value in values.items())
        who = note(request, person, "set_parameter", f"{given.model_name}/{given.record_name} {reported}"[:500])
        client.set_parameter(given.model_name, given.record_name, values, who, given.create, given.type)
        return Nothing()


LIMITS: dict[str, type[Reason]] = {"int": IntTooLong, "double": NotFinite, "string": NotUnicode}


def _typed(field: FieldGiven) -> Any:
    """The value in its type: JSON writes 3.0 as 3."""
    kinds: dict[str, tuple[type, ...]] = {"bool": (bool,), "int": (int,), "double": (int, float), "string": (str,)}
    kind = field.type.removesuffix("[]")
    several = field.type.endswith("[]")
    values = field.value if isinstance(field.value, list) else [field.value]
    wrong = [one for one in values if not isinstance(one, kinds[kind]) or isinstance(one, bool) != (kind == "bool")]
    if wrong or several != isinstance(field.value, list):
        raise TmsError(BadValue(field.name, repr(field.value), NotOfType(field.type)))
    if not all(_fits(kind, one) for one in values):
        raise TmsError(BadValue(field.name, repr(field.value), LIMITS[kind]()))
    typed = [float(one) if kind == "double" else one for one in values]
    return typed if several else typed[0]


def _fits(kind: str, value: Any) -> bool:
    """Whether ROS and the database can hold the value: JSON also has longer numbers, and halves of characters."""
    try:
        if kind == "double":
            return math.isfinite(value)
        if kind == "string":
            value.encode()
            return "\0" not in value  # ROS would cut the text at a NUL
    except (OverflowError, UnicodeEncodeError):
        return False
    return kind != "int" or -(2**63) <= value < 2**63


def _places(app: FastAPI, client: "SiteClient", note: _Note) -> None:
    @app.post("/api/places/{name}/revoke", summary="Take a shared place from its holder", responses=ANSWERS)
    def revoke(request: Request, name: PlaceName, _: Nothing, person: Operator) -> Revoked:
        who = note(request, person, "revoke_place_asked", name)
        return Revoked(place=name, holder=client.shared.revoke(name, who))


def _areas(app: FastAPI, client: "SiteClient", note: _Note) -> None:
    @app.post("/api/areas/check", summary="What would change if areas were enabled; enables nothing", responses=ANSWERS)
    def check(given: AreasGiven, person: Viewer) -> AreasChecked:
        return client.check_areas(given.areas)

    @app.post("/api/areas/enable", summary="Let areas count from now on, at every gateway", responses=ANSWERS)
    def enable(request: Request, given: AreasWanted, person: Admin) -> Nothing:
        who = note(request, person, "enable_areas_asked", given.id)
        client.enable_areas(given.areas, given.id, who)
        return Nothing()


def _processes(app: FastAPI, client: "SiteClient", note: _Note) -> None:
    @app.post("/api/processes/{name}/restart", summary="Restart a process", responses=ANSWERS)
    def restart(request: Request, name: ProcessName, _: Nothing, person: Operator) -> Nothing:
        note(request, person, "restart", name)
        client.restart(name)
        return Nothing()


def _interrupted(app: FastAPI, client: "SiteClient", note: _Note) -> None:
    @app.post("/api/runs/{run_id}/resume", status_code=202, summary="Go on with an interrupted run; answers when it "
              "has begun", responses=ANSWERS)  # fmt: skip
    def resume(request: Request, run_id: RunId, _: Nothing, person: Operator) -> RunAsked:
        note(request, person, "resume_run", run_id)
        return RunAsked(run_id=client.start_run(0, True, run_id))

    @app.post("/api/runs/{run_id}/abandon", summary="Give up an interrupted run for good", responses=ANSWERS)
    def abandon(request: Request, run_id: RunId, _: Nothing, person: Operator) -> RunAsked:
        note(request, person, "abandon_run", run_id)
        client.abandon_run(run_id)
        return RunAsked(run_id=run_id)
