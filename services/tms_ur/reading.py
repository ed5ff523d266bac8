"""Endpoints that only show something; every role may call them."""

import difflib
from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Annotated, Literal

from fastapi import FastAPI, Path, Query, Request, Response
from pydantic import AwareDatetime

from tms_config.clock import utc_now
from tms_config.config import Site
from tms_config.reasons import NoMachine, NoPlannedArm
from tms_reason import wire
from tms_reason.errors import TmsError
from tms_reason.names import Name
from tms_reason.reason import Reason
from tms_ur import export
from tms_ur.audit_chain import RUN as AUDIT
from tms_ur.command_models import Xml
from tms_ur.data_models import Change, Record, Sensing
from tms_ur.ground_models import Ground
from tms_ur.models import (
    INT32,
    Checked,
    Diff,
    Event,
    Finding,
    Log,
    Run,
    Task,
    TaskText,
    Template,
    Tree,
)
from tms_ur.place_models import SharedPlaces
from tms_ur.problems import Viewer, problems
from tms_ur.reason_view import view
from tms_ur.reasons import JournalCut, NoTree
from tms_ur.scene_models import Scene
from tms_ur.start_models import BlackboardNow, ResumePlan, TaskMachines
from tms_ur.state_models import State
from tms_ur.stream import Stream, StreamResponse
from tms_ur.task_machines import machines_of
from tms_ur.watch_models import EnabledAreas

if TYPE_CHECKING:
    from tms_ur.audit import Audit
    from tms_ur.site_client import SiteClient

UINT32 = 2**32 - 1
PAGE = 1000  # events in one answer
MAX_EVENTS = 200_000  # events in an export
BEGINNING = 50  # first events of a run, which include the shape of the tree

RunId = Annotated[str, Path(pattern=r"^[0-9A-Za-z_-]{1,64}$", description="id of a run")]
TaskId = Annotated[int, Path(ge=1, le=INT32)]
MachineName = Annotated[str, Path(pattern=r"^[a-z][a-z0-9_]{0,63}$")]
PlaceName = Annotated[str, Path(min_length=1, max_length=64, description="id of a release area")]
ProcessName = Annotated[str, Path(pattern=r"^[0-9A-Za-z_]{1,64}:[0-9A-Za-z_]{1,64}$", description="group:name")]


def add(app: FastAPI, client: "SiteClient", audit: "Audit", site: Site) -> None:
    """Add these endpoints to the application."""
    _live(app, client, site)
    _seen(app, client)
    _stored(app, client)
    _audit(app, client, audit)
    _data(app, client)
    _tasks(app, client, site)
    _scenes(app, client, site)


def _live(app: FastAPI, client: "SiteClient", site: Site) -> None:
    stream = Stream(client.board)

    # `async` where the endpoint waits for nothing, so that it answers even when all workers wait for a module
    @app.get("/api/state", summary="Machines, active runs, questions and processes as they are now")
    async def state() -> State:
        return client.board.snapshot()

    @app.get("/api/places", summary="Shared places: who holds them, since when, and who waits")
    async def places() -> SharedPlaces:
        return client.board.snapshot().shared

    @app.get(
        "/api/events",
        summary="The state as server-sent events `state`: on change, at most 10/s, at least every second",
        status_code=200,
        response_class=StreamResponse,
        responses=problems(503) | {200: {"content": {"text/event-stream": {"schema": {"type": "string"}}}}},
    )
    async def events(request: Request) -> StreamResponse:
        return StreamResponse(stream)

    @app.get("/api/processes/{name}/log", summary="The end of a process's log", responses=problems(404, 409, 503))
    def log(
        name: ProcessName, size: Annotated[int, Query(ge=100, le=200_000, description="bytes at most")] = 16_384
    ) -> Log:
        return Log(text=client.log(name, size))


def _seen(app: FastAPI, client: "SiteClient") -> None:
    @app.get("/api/runs/{run_id}/blackboard", summary="What a node sees of the blackboard now", responses=problems(503))
    def blackboard(run_id: RunId, node: Annotated[str, Query(pattern=r"^0(\.[0-9]{1,6}){0,200}$")]) -> BlackboardNow:
        return BlackboardNow(values=client.blackboard(run_id, node))


def _stored(app: FastAPI, client: "SiteClient") -> None:
    @app.get("/api/runs", summary="The history, newest first", responses=problems(503))
    def runs(limit: Annotated[int, Query(ge=1, le=1000)] = 20) -> list[Run]:
        return client.runs(limit)

    @app.get("/api/runs/{run_id}/events", summary="The journal of a run, in order", responses=problems(404, 503))
    def run_events(
        run_id: RunId,
        after: Annotated[int, Query(ge=0, le=UINT32, description="only events with a greater number")] = 0,
        limit: Annotated[int, Query(ge=1, le=PAGE)] = PAGE,
    ) -> list[Event]:
        return client.events(run_id, after, limit)

    @app.get("/api/runs/{run_id}/tree", summary="The shape of a run's tree", responses=problems(404, 503))
    def run_tree(run_id: RunId) -> Tree:
        for event in client.events(run_id, 0, BEGINNING):
            if event.kind == "tree":
                return Tree.model_validate(event.values)
        raise TmsError(NoTree(run_id))

    @app.get(
        "/api/runs/{run_id}/export",
        summary="The journal as a file",
        responses=problems(404, 503) | {200: {"content": {kind: {} for kind in export.TYPES.values()}}},
        response_class=Response,
    )
    def run_export(run_id: RunId, form: Literal["json", "csv", "mcap"] = "json") -> Response:
        found = all_events(client, run_id)
        name = f'attachment; filename="{run_id}.{form}"'
        return Response(export.FORMS[form](run_id, found), 200, {"Content-Disposition": name}, export.TYPES[form])

    @app.get("/api/runs/{run_id}/resume", summary="What resuming would do", responses=problems(404, 409, 503))
    def resume_plan(run_id: RunId) -> ResumePlan:
        return client.resume_plan(run_id)

    @app.get("/api/parameters", summary="Parameter records", responses=problems(503))
    def parameters(
        model_name: Annotated[str, Query(pattern=r"^[0-9A-Za-z_]{0,64}$", description="empty: of all machines")] = "",
    ) -> list[Record]:
        return client.parameters(model_name)


def _audit(app: FastAPI, client: "SiteClient", audit: "Audit") -> None:
    @app.get("/api/audit", summary="The last of who did what, oldest first", responses=problems(503))
    def newest(
        hours: Annotated[float, Query(gt=0, le=24 * 366)] = 24, limit: Annotated[int, Query(ge=1, le=PAGE)] = PAGE
    ) -> list[Event]:
        since = utc_now() - timedelta(hours=hours)
        return _newest_of_audit(client, audit.number(), since, limit)


def _data(app: FastAPI, client: "SiteClient") -> None:
    @app.get("/api/parameters/history", summary="The last changes of a record, newest first",
             responses=problems(404, 503))  # fmt: skip
    def parameter_history(
        record_name: Annotated[Name, Query()],
        model_name: Annotated[str, Query(pattern=r"^[0-9A-Za-z_]{0,64}$", description="empty: shared by all")] = "",
        limit: Annotated[int, Query(ge=1, le=200)] = 20,
    ) -> list[Change]:
        return client.parameter_history(model_name, record_name, limit)

    @app.get("/api/sensing", summary="The sensing inputs: rate, age, refusals")
    async def sensing() -> Sensing:
        return client.sensing()


def _tasks(app: FastAPI, client: "SiteClient", site: Site) -> None:
    @app.get("/api/tasks", summary="Stored tasks", responses=problems(503))
    def tasks() -> list[Task]:
        return client.tasks()

    @app.get("/api/tasks/{task_id}", summary="One task with its tree", responses=problems(404, 503))
    def task(task_id: TaskId) -> TaskText:
        return client.task(task_id)

    @app.get("/api/tasks/{task_id}/machines", summary="Which machines it moves", responses=problems(404, 409, 503))
    def task_machines(task_id: TaskId) -> TaskMachines:
        return TaskMachines(machines=machines_of(client.task(task_id).xml, client.template, site.file.machines))

    @app.get("/api/templates", summary="Stored templates, by name", responses=problems(503))
    def templates() -> list[Template]:
        return client.templates()

    @app.post("/api/tasks/check", summary="Check a tree; stores and runs nothing",
              responses=problems(403, 409, 411, 413, 415, 503))  # fmt: skip
    def check(
        given: Xml,
        person: Viewer,
        motions: Annotated[bool, Query(description="plan the motions, too: that takes up to 2 s")] = True,
    ) -> Checked:
        errors, warnings = client.check_task(given.xml, motions)
        return Checked(errors=list(map(_finding, errors)), warnings=list(map(_finding, warnings)))

    @app.post("/api/tasks/{task_id}/diff", summary="What differs between the stored tree and a given one",
              responses=problems(403, 404, 409, 411, 413, 415, 503))  # fmt: skip
    def diff(task_id: TaskId, given: Xml, person: Viewer) -> Diff:
        stored = client.task(task_id).xml.splitlines()
        lines = difflib.unified_diff(stored, given.xml.splitlines(), f"task {task_id}", "this file", lineterm="")
        return Diff(text="\n".join(lines))


def _scenes(app: FastAPI, client: "SiteClient", site: Site) -> None:
    names = tuple(site.file.machines)

    @app.get("/api/areas", summary="The enabled areas, as a gateway holds its machine in them")
    def areas() -> EnabledAreas:
        return client.watching.areas()

    @app.get(
        "/api/ground",
        summary="Heights of the ground and of the design, of the whole site",
        responses=problems(404, 503),
    )
    def ground(
        cells: Annotated[int, Query(ge=100, le=200_000, description="about how many at most")] = 40_000,
        at: Annotated[AwareDatetime | None, Query(description="the last one kept until then; none: of now")] = None,
    ) -> Ground:
        if site.file.ground is None:
            return Ground()
        return client.ground(cells) if at is None else client.ground_at(at, cells)

    @app.get("/api/machines/{name}/scene", summary="What the planner of an excavator plans among now",
             responses=problems(404, 409, 503))  # fmt: skip
    def scene(name: MachineName) -> Scene:
        if name not in names:
            raise TmsError(NoMachine(name, names))
        if site.model_of(name).planner is None:
            raise TmsError(NoPlannedArm(name))
        return client.scene(name)


def all_events(client: "SiteClient", run_id: str) -> list[Event]:
    """The journal of a run; where it is too long for an export, the last entry says so."""
    found: list[Event] = []
    while len(found) < MAX_EVENTS:
        page = client.events(run_id, found[-1].number if found else 0, PAGE)
        found += page
        if len(page) < PAGE:
            return found
    last = found[-1].number
    if client.events(run_id, last, 1):
        cut = JournalCut(len(found), run_id, last)
        found.append(Event(number=last, stamp=found[-1].stamp, kind="cut", node="", text=wire.to_line(cut),
                           reason=view(cut)))  # fmt: skip
    return found


def _newest_of_audit(client: "SiteClient", last: int, since: datetime, limit: int) -> list[Event]:
    """The end of the journal, searched further and further back: the numbers of old entries have gaps."""
    back = limit
    while True:
        after = max(0, last - back)
        found = _audit_after(client, after)
        young = [event for event in found if event.stamp is not None and event.stamp >= since]
        if after == 0 or len(young) >= limit or len(young) < len(found):
            return young[-limit:]
        back *= 8


def _audit_after(client: "SiteClient", after: int) -> list[Event]:
    """The entries after a number; of many, the last pages."""
    found: list[Event] = []
    while True:
        try:
            page = client.events(AUDIT, after, PAGE)
        except TmsError as error:
            if error.code != "RUN_MISSING":  # there is no journal, or no entry after a full page
                raise
            page = []
        found = [*found[-PAGE:], *page]
        if len(page) < PAGE:
            return found
        after = page[-1].number


def _finding(reason: Reason) -> Finding:
    return Finding(line=_line(reason), reason=view(reason))


def _line(reason: Reason) -> int | None:
    """The line of the task's text from the reason or a reason inside it; None if neither names one."""
    line = reason.args.get("line")
    inner = (one for one in reason.args.values() if isinstance(one, Reason))
    return line if isinstance(line, int) else next((found for one in inner if (found := _line(one)) is not None), None)
