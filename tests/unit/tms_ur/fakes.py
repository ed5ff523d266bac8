"""A site without ROS: the site client that the API's tests talk to, and a client without a network."""

import asyncio
import threading
from dataclasses import replace
from datetime import date, datetime, timedelta, timezone
from functools import cache
from pathlib import Path
from typing import Any

import httpx
from fastapi import FastAPI
from geometry_msgs.msg import Point, Vector3
from tms_msg_rp.msg import SceneArea, SceneBody
from tms_msg_rp.srv import GetScene

from tms_config.config import CONFIGS, Site, load_site
from tms_config.models import MachineModel
from tms_config.site_file import Console, SiteFile
from tms_config.yaml_file import parse
from tms_db.reasons import GroundNotThere
from tms_decision.reasons import GivenBack, SoftwareStop
from tms_reason.errors import TmsError
from tms_reason.reason import Foreign, Reason
from tms_reason.remedies import EDIT_TASK
from tms_reason.wire import to_line
from tms_report.facts import Facts
from tms_rp.reasons import PartOf
from tms_ur.access import Access
from tms_ur.api import create_app
from tms_ur.board import Board
from tms_ur.data_models import Change, Record, Sensing, SensingInput
from tms_ur.ground_models import Ground
from tms_ur.models import AddedTemplate, Event, Rearmed, Receipt, Run, Task, TaskText, Template
from tms_ur.reason_view import of_line, view
from tms_ur.recording_client import Asked
from tms_ur.recording_models import Recording, Series
from tms_ur.report_client import FORMS, Wanted
from tms_ur.scene_models import Scene, scene
from tms_ur.start_models import ResumePlan
from tms_ur.watch_models import AreaChange, AreasChecked, EnabledAreas
from tms_ur.work_models import Work, sum_of
from tms_work import sums
from tms_work.cycle import Cycle, Kind
from tms_work.plan import Plan

NOON = datetime(2026, 1, 31, 12, tzinfo=timezone.utc)
HERE = "http://127.0.0.1:8080"
XML = "<root><BehaviorTree ID='A'/></root>"


class WrongLine(Reason, text="line {line}: there is no node '{node}'", action=EDIT_TASK):
    """A finding as the scheduler has them."""

    line: int
    node: str


class FakeWatching:
    """One area that a person has enabled."""

    def areas(self) -> EnabledAreas:
        ring = [[-5.0, -5.0], [20.0, -5.0], [20.0, 20.0], [-5.0, 20.0], [-5.0, -5.0]]
        geometry = {"type": "Polygon", "coordinates": [ring]}
        yard = {"type": "Feature", "properties": {"id": "yard", "type": "unmanned"}, "geometry": geometry}
        return EnabledAreas(id="9f", by="a person", areas={"type": "FeatureCollection", "features": [yard]})


def cycle(day: date, number: int, kind: Kind, **facts: Any) -> Cycle:
    """One of an excavator or a carrier, that begins some times twelve minutes after nine, and takes some seconds."""
    begun = datetime(day.year, day.month, day.day, 9, tzinfo=timezone.utc) + timedelta(minutes=12 * number)
    machine = {"dig": "zx200", "haul": "ic120"}[kind]
    return Cycle(run_id="r-1", machine=machine, number=number + 1, kind=kind, begun_at=begun,
                 ended_at=begun + timedelta(seconds=sum(facts["parts"].values())), **facts)  # fmt: skip


class FakePlaces:
    """The keeper of shared places."""

    def __init__(self, client: "FakeSiteClient") -> None:
        self._client = client

    def revoke(self, place: str, who: str) -> str:
        self._client._called("revoke", place, who)
        return "zx200"


class FakeSiteClient:
    """Same methods as the real one; `error` is what the next call raises, `calls` what was asked."""

    def __init__(self) -> None:
        self.board = Board(["zx200"])
        self.watching = FakeWatching()
        self.palette = ""
        self.error: TmsError | None = None
        self.calls: list[tuple[object, ...]] = []
        self.unrecorded = False  # runs of before there were recordings
        self.shared = FakePlaces(self)

    def tasks(self) -> list[Task]:
        self._called("tasks")
        return [Task(id=4, model_name="zx200", description="掘削", added_at=NOON)]

    def task(self, task_id: int) -> TaskText:
        self._called("task", task_id)
        return TaskText(id=task_id, model_name="zx200", description="掘削", added_at=NOON, xml=XML)

    def template(self, name: str) -> str:
        self._called("template", name)
        return XML

    def templates(self) -> list[Template]:
        self._called("templates")
        return [Template(name="Dig", model_name="zx200", description="掘削", added_at=NOON)]

    def add_template(self, name: str, xml: str, description: str, replace: bool) -> AddedTemplate:
        self._called("add_template", name, xml, description, replace)
        return AddedTemplate(already_stored=False, replaced=replace)

    def runs(self, limit: int) -> list[Run]:
        self._called("runs", limit)
        facts = {"run_id": "r-1", "task_id": 4, "description": "掘削", "machines": ["zx200"], "started_at": NOON}
        return [Run(**facts, state="failure", reason=of_line("pose out of reach"), ended_at=NOON)]

    def events(self, run_id: str, after: int, limit: int) -> list[Event]:
        self._called("events", run_id, after, limit)
        shape = {"paths": ["0"], "names": ["all"], "types": ["Sequence"], "kinds": ["control"], "ports": [""]}
        return [
            Event(number=after + 1, stamp=NOON, kind="run", node="", text="running", values={"n": 1}),
            Event(number=after + 2, stamp=NOON, kind="tree", node="", text="1 node", values=shape),
        ]

    def recording(self, asked: Asked) -> Recording:
        """An arm that moves while its machine drives 10 m east, for 10 s from noon on."""
        self._called("recording", asked)
        since = NOON.timestamp()
        times = [since + tick / 10 for tick in range(101)]
        arm = Series(machine="zx200", kind="joints", names=["swing_joint", "boom_joint"], times=times,
                     values=[[tick / 100 for tick in range(101)], [-0.5] * 101])  # fmt: skip
        way = Series(machine="zx200", kind="pose", names=["x", "y", "yaw"], times=times[::2],
                     values=[[tick / 5 for tick in range(51)], [2.0] * 51, [0.5] * 51])  # fmt: skip
        load = Series(machine="zx200", kind="load", names=["mass", "bank", "loose"], times=times[::10],
                      values=[[0.0, *[1600.0] * 10], [0.0, *[0.8] * 10], [0.0, *[1.0] * 10]])  # fmt: skip
        inside = asked.begin <= since <= (asked.end or since)
        return Recording(series=[arm, load, way] if inside and not self.unrecorded else [])

    def parameters(self, model_name: str) -> list[Record]:
        self._called("parameters", model_name)
        values = {"i": 3, "d": 3.0, "b": True, "s": "3", "dd": [1.0, 2.5], "nan": float("nan")}
        return [
            Record(model_name="zx200", record_name="pose", type="static", description="", source="cli", values=values)
        ]

    def parameter_history(self, model_name: str, record_name: str, limit: int) -> list[Change]:
        self._called("parameter_history", model_name, record_name, limit)
        return [Change(stamp=NOON, source="sensing", values={"d": float("nan"), "s": "3"})]

    def scene(self, machine: str) -> Scene:
        self._called("scene", machine)
        body = SceneBody(kind="machine", name=to_line(PartOf("vessel", "ic120_1")), margin=0.5, age=3.0,
                         size=Vector3(x=2.0, y=2.0, z=4.0), triangles=[Point()] * 3)  # fmt: skip
        body.pose.position.x, body.pose.position.y, body.pose.position.z = 8.0, 2.0, 2.0
        area = SceneArea(record="dig", centre=Point(x=5.0), size=Vector3(x=2.0, y=1.0, z=0.5))
        return scene(machine, GetScene.Response(bodies=[body], areas=[area], way=[Point(x=6.0, z=1.0)]))

    def check_areas(self, areas: dict[str, Any]) -> AreasChecked:
        self._called("check_areas", areas)
        change = AreaChange(id="yard", kind="changed", before=625.0, after=600.0, away=25.0, new=0.0)
        return AreasChecked(id="a0", changes=[change], refusals=[])

    def enable_areas(self, areas: dict[str, Any], shown: str, who: str) -> None:
        self._called("enable_areas", areas, shown, who)

    def ground(self, cells: int) -> Ground:
        self._called("ground", cells)
        return Ground(cell=10.0, rows=1, columns=2, heights=[1.25, None], design=[0.5, None])

    def ground_at(self, time: datetime, cells: int) -> Ground:
        """One was kept an hour before noon, and one 5 s after it."""
        self._called("ground_at", time, cells)
        first, second = NOON - timedelta(hours=1), NOON + timedelta(seconds=5)
        if time < first:
            raise TmsError(GroundNotThere("last"), "GROUND_NOT_THERE")
        taken, after = (first, second) if time < second else (second, None)
        return Ground(cell=10.0, rows=1, columns=2, heights=[0.75, None], taken_at=taken, next_at=after)

    def work(self, day: date, plan: Plan | None) -> Work:
        """Ten buckets between nine and eleven, of which a truck took two away."""
        self._called("work", day, plan)
        dug = [cycle(day, number, "dig", bank=0.8, loose=1.0, parts={"dig": 12.0, "dump": 8.0}) for number in range(10)]
        hauled = cycle(day, 3, "haul", loose=2.0, parts={"haul": 60.0}, distance=500.0)
        cycles = [*dug, hauled]
        return Work(
            day=day, plan=plan, total=sum_of("", sums.total(cycles)),
            machines=[sum_of(name, one) for name, one in sums.by(cycles, lambda one: one.machine).items()],
            hours=[sum_of(name[-2:], one) for name, one in sums.by(cycles, sums.hour(timezone.utc)).items()],
        )  # fmt: skip

    def report(self, wanted: "Wanted") -> bytes:
        """Of the same buckets."""
        self._called("report", wanted)
        cycles = tuple(cycle(wanted.day, number, "dig", bank=0.8, parts={"dig": 20.0}) for number in range(10))
        return FORMS[wanted.form](Facts(wanted.site, wanted.day, cycles, wanted.language, wanted.plan))

    def sensing(self) -> Sensing:
        facts = {"name": "pile", "topic": "/pile", "state": "alive", "hz": 1.0, "hz_expected": None, "age": 0.5}
        counts = {
            "accepted": 3,
            "refused": 1,
            "last_refusal": of_line("z: 99.0 is above 5.0"),
            "records": ["zx200/PILE"],
        }
        return Sensing(age=0.2, inputs=[SensingInput(**facts, **counts)])

    def add_task(self, xml: str, description: str) -> tuple[int, bool]:
        self._called("add_task", xml, description)
        return 5, False

    def remove_task(self, task_id: int) -> None:
        self._called("remove_task", task_id)

    def check_task(self, xml: str, motions: bool = True) -> tuple[list[Reason], list[Reason]]:
        self._called("check_task", xml, motions)
        return [WrongLine(7, "Dig")], [Foreign("nobody writes flag F")]

    def set_parameter(
        self, model_name: str, record_name: str, values: dict[str, Any], source: str, create: bool, kind: str
    ) -> None:
        self._called("set_parameter", model_name, record_name, values, source, create, kind)

    def answer(self, question: str, yes: bool, by: str) -> None:
        self._called("answer", question, yes, by)

    def stop(self, machines: list[str], cause: Reason) -> list[Receipt]:
        for machine in machines:
            self._called("stop", machine, cause)
        return [
            Receipt(
                machine=machine, confirmed=True, seconds=0.4, travel_joint="swing_joint", travel_rad=0.01, travel_m=0.0,
                cause=view(cause), detail=None, evidence=None, latched=True,
            )
            for machine in machines
        ]  # fmt: skip

    def give_back(self, machine: str, who: str) -> Receipt:
        self._called("give_back", machine, who)
        return Receipt(
            machine=machine, confirmed=True, seconds=0.4, travel_joint="", travel_rad=0.0, travel_m=0.0,
            cause=view(GivenBack(who)), detail=None, evidence=None, latched=False,
        )  # fmt: skip

    def rearm(self, machine: str, token: str) -> Rearmed:
        self._called("rearm", machine, token)
        return Rearmed(token="" if token else "t-1", cause=view(SoftwareStop()), armed=bool(token))

    def let_back(self, machine: str, who: str) -> None:
        self._called("let_back", machine, who)

    def restart(self, process: str) -> None:
        self._called("restart", process)

    def log(self, process: str, size: int) -> str:
        self._called("log", process, size)
        return "event=started\n"

    def start_run(self, task_id: int, ignore_warnings: bool, resume: str = "") -> str:
        self._called("start_run", task_id, ignore_warnings, *([resume] if resume else []))
        return resume or "r-2"

    def resume_plan(self, run_id: str) -> ResumePlan:
        self._called("resume_plan", run_id)
        return ResumePlan(task_id=4, done=["dig"], next=["swing"])

    def blackboard(self, run_id: str, node: str) -> dict[str, Any]:
        self._called("blackboard", run_id, node)
        return {"target": "R7", "count": 3}

    def abandon_run(self, run_id: str) -> None:
        self._called("abandon_run", run_id)

    def cancel_run(self, run_id: str) -> None:
        self._called("cancel_run", run_id)

    def _called(self, *what: object) -> None:
        self.calls.append(what)
        if self.error is not None:
            raise self.error


class FakeAudit:
    """Keeps what was audited, all on its disk at once; `last` is the number of the last entry."""

    def __init__(self) -> None:
        self.notes: list[tuple[str, str, str, str]] = []
        self.refusals: list[tuple[str, str, str, str]] = []
        self.kept = threading.Event()
        self.kept.set()
        self.last = 0

    def put(self, who: str, source: str, what: str, target: str) -> threading.Event:
        self.notes.append((who, source, what, target))
        return self.kept

    def refused(self, who: str, source: str, what: str, why: str) -> None:
        self.refusals.append((who, source, what, why))

    def number(self) -> int:
        return self.last


ZX200 = {"zx200": {"model": "zx200"}}


@cache
def demo() -> tuple[Site, dict[str, Any]]:
    """The demo's site, with a truck's model, and its file as data: to read them takes longer than most tests."""
    site = load_site()
    truck = parse(CONFIGS / "machines" / "ic120.yaml", MachineModel)
    return replace(site, models={**site.models, "ic120": truck}), site.file.model_dump(exclude_unset=True)


def site(**changes: Any) -> Site:
    """The demo's site with its excavator only, changed."""
    whole, data = demo()
    return replace(whole, file=SiteFile.model_validate({**data, "machines": ZX200, **changes}))


def app(site_client: FakeSiteClient, bind: str = "127.0.0.1", users: Path | None = None, **parts: Any) -> FastAPI:
    """The application with fakes; `parts` may hold an audit, a clock, machines, a ground, settings of the console."""
    access = Access(users, parts["clock"]) if "clock" in parts else Access(users)
    told = {name: parts[name] for name in ("machines", "ground") if name in parts}
    where = site(bind=bind, console=parts.get("console", Console()), **told)
    return create_app(site_client, parts.get("audit", FakeAudit()), where, access)  # type: ignore[arg-type]


class Client:
    """Sends requests straight into the application."""

    def __init__(self, app: Any, base_url: str = HERE, address: str = "127.0.0.1") -> None:
        self.app, self._base_url, self._address = app, base_url, address

    def request(self, method: str, path: str, **options: Any) -> httpx.Response:
        async def ask() -> httpx.Response:
            transport = httpx.ASGITransport(self.app, raise_app_exceptions=False, client=(self._address, 123))
            async with httpx.AsyncClient(transport=transport, base_url=self._base_url) as client:
                return await client.request(method, path, **options)

        return asyncio.run(ask())

    def get(self, path: str, **options: Any) -> httpx.Response:
        return self.request("GET", path, **options)

    def post(self, path: str, **options: Any) -> httpx.Response:
        return self.request("POST", path, **options)
