"""Models of the API's answers, with units; ROS types are not part of the API."""

from datetime import datetime
from typing import Any, Literal

from pydantic import Field

from tms_ur.base_model import Model
from tms_ur.reason_view import ReasonView
from tms_ur.watch_models import Watched

Document = dict[str, Any]
Plain = bool | int | float | str | list[bool] | list[int] | list[float] | list[str]
Value = Plain | Document | list[Document]
MachineState = Literal["moving", "standing", "not_ready", "silent"]
INT32 = 2**31 - 1


class Joint(Model):
    """A joint of a machine as it is now."""

    name: str
    position: float = Field(description="rad")
    velocity: float = Field(description="rad/s")


class Place(Model):
    """Where a machine stands, frame `map`."""

    x: float = Field(description="m")
    y: float = Field(description="m")
    yaw: float = Field(description="rad")


class LastStop(Model):
    """The last stop of a machine."""

    stamp: datetime | None = Field(description="when it was commanded")
    confirmed: bool = Field(description="the machine was seen to stand still")


class Load(Model):
    """Soil in a bucket or a vessel."""

    mass: float = Field(description="kg")
    loose: float = Field(description="m3, as it is carried")
    capacity: float = Field(description="m3, loose, that it holds at most")
    measured: bool = Field(description="weighed or scanned; else estimated from motions and shapes")


class Machine(Model):
    """A machine as its gateway sees it."""

    name: str
    state: MachineState = Field(
        default="silent", description="silent: its gateway says nothing, what else is here is old"
    )
    reason: ReasonView | None = Field(default=None, description="why it is not ready or silent")
    goal: str = Field(default="", description="id of the goal that it executes now, empty if none")
    owner: str = Field(default="", description="who sent the goal")
    armed: bool = Field(default=False, description="motions are accepted")
    latch: ReasonView | None = Field(default=None, description="why it is stopped until it is re-armed; null: armed")
    hold: ReasonView | None = Field(default=None, description="why it is held until its run goes on")
    by_hand: str = Field(default="", description="who drives it by hand, empty if nobody does")
    since: datetime | None = Field(
        default=None, description="since when this console knows its state, latch, hold and reason as they are"
    )
    last_stop: LastStop | None = Field(default=None, description="null: none since its gateway began")
    lamp: Literal["automatic", "manual", "stopped", "fault"] = Field(default="fault", description="what its lamp shows")
    watched: Watched = Watched()
    place: Place | None = Field(default=None, description="null: never told")
    place_age: float | None = Field(default=None, description="s since the place was told, null: never")
    way: list[tuple[float, float]] = Field(default=[], description="places of the way that it drives now [m, map]")
    load: Load | None = Field(default=None, description="null: it carries no soil, or nobody tells")
    joints: list[Joint] = Field(default=[])
    joint_age: float | None = Field(default=None, description="s since the last joint states, null: never")
    age: float | None = Field(default=None, description="s since the gateway last reported, null: never")


class ActiveRun(Model):
    """A run that goes on now."""

    run_id: str
    task_id: int
    state: str = Field(description="preparing, running or stopping")
    machines: list[str] = Field(default=[])
    reason: ReasonView | None = Field(default=None, description="why it does not move on")
    reason_since: datetime | None = Field(default=None, description="since when this console knows this reason")
    started_at: datetime | None = None
    leaf: str = Field(default="", description="path of the leaf that works or waits")
    nodes: str = Field(default="", description="a digit a node in the order of its tree: 0 idle, 1 running, 2 success, "
                       "3 failure")  # fmt: skip


class Question(Model):
    """A run waits for an operator's yes or no."""

    id: str
    run_id: str
    node: str = Field(description="path of the node")
    title: str
    text: str
    asked_at: datetime | None = None
    until: datetime | None = Field(default=None, description="when a Timeout ends it, null: never")


class Scheduler(Model):
    """How fresh the list of active runs is."""

    alive: bool = False
    age: float | None = Field(default=None, description="s since the scheduler last reported, null: never")


class Process(Model):
    """A process of the site."""

    name: str = Field(description="group:name")
    state: str = Field(description="as supervisord names it: RUNNING, STOPPED, FATAL, ...; UNKNOWN: its PC is silent")
    pid: int = 0
    restarts: int = Field(default=0, description="since the host agent started")
    uptime: float = Field(default=0.0, description="s")
    cpu: float = Field(default=0.0, description="% of one core, over the last seconds")
    memory: int = Field(default=0, description="bytes in RAM")
    on_demand: bool = Field(default=False, description="it runs only while it is needed: stopped is no fault")
    detail: ReasonView | None = None


class Host(Model):
    """One PC of the site; its agent speaks every 2 s, and at once when something changes."""

    name: str
    age: float = Field(default=0.0, description="s since its agent last reported")
    processes: list[Process] = Field(default=[])


class Task(Model):
    """A stored task (behaviour tree)."""

    id: int
    model_name: str
    description: str
    added_at: datetime | None = None


class TaskText(Task):
    """A stored task with its tree."""

    xml: str = Field(description="the tree as Groot draws it")


class Template(Model):
    """A stored template: a tree that tasks call by its name."""

    name: str
    model_name: str
    description: str
    added_at: datetime | None = None


class Run(Model):
    """A run as the history keeps it."""

    run_id: str
    task_id: int
    description: str
    state: str
    reason: ReasonView | None = None
    machines: list[str]
    started_at: datetime | None = None
    ended_at: datetime | None = Field(default=None, description="null while it runs")
    values: dict[str, Value | None] = Field(default={}, description="what else the scheduler tells of it, by name")


class Event(Model):
    """One entry of a run's journal."""

    number: int = Field(description="counts from 1 in each run")
    stamp: datetime | None = None
    kind: str = Field(description="run, node, goal, stop, ...")
    node: str = Field(description="path of the node, empty if none")
    text: str = Field(description="as it is stored: a reason's line, or words")
    reason: ReasonView | None = Field(default=None, description="of a text that is a reason's line")
    values: dict[str, Value | None] = Field(default={}, description="null: not a number, or infinite")


class Tree(Model):
    """The shape of a run's tree: one entry a node in each list, in the order of `nodes` of a state."""

    paths: list[str] = Field(description="child positions from the root, for example 0.1.2")
    names: list[str]
    types: list[str]
    kinds: list[str] = Field(description="control, decorator, subtree, action or condition")
    ports: list[str] = Field(description="as written")
    templates: list[str] = Field(
        default=[], description="TEMPLATE:LINE of nodes that come from a template; empty where none does"
    )


class Receipt(Model):
    """A stop as a measured fact."""

    machine: str
    confirmed: bool = Field(description="the machine was seen to stand still")
    seconds: float = Field(description="s from the request until it stood")
    travel_joint: str = Field(description="joint that went furthest meanwhile, empty if none did")
    travel_rad: float = Field(description="rad that this joint went")
    travel_m: float = Field(description="m that the machine went")
    cause: ReasonView | None
    detail: ReasonView | None = Field(description="why it is not confirmed")
    evidence: ReasonView | None = Field(description="what it rests on, where that is less than stamped messages")
    latched: bool = Field(description="nothing moves until it is re-armed")


class Finding(Model):
    """Something that the check found."""

    line: int | None = Field(description="of the tree's text, null: of none")
    reason: ReasonView


class Checked(Model):
    """Result of a check; nothing was stored and nothing ran."""

    errors: list[Finding]
    warnings: list[Finding]


class Added(Model):
    """What came of storing a task."""

    id: int
    already_stored: bool = Field(description="the same text was there under this number")


class AddedTemplate(Model):
    """What came of storing a template."""

    already_stored: bool = Field(description="the same text was there under this name")
    replaced: bool = Field(description="another text was there under this name")


class Diff(Model):
    """How two trees differ."""

    text: str = Field(description="unified diff from the stored tree to the given one, empty if they are equal")


class Log(Model):
    """The end of a log."""

    text: str = Field(description="the last lines")


class Rearmed(Model):
    """First step: cause and a token. Second step, with the token: armed."""

    token: str
    cause: ReasonView | None
    armed: bool


class RunAsked(Model):
    """A command about a run was taken; its state tells how it goes on."""

    run_id: str
