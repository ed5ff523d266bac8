"""Model of configs/machines/<model>.yaml: a machine's body, its limits, its border names, its subtasks."""

from typing import Any, Literal, get_args

from pydantic import BaseModel, ConfigDict, Field, model_validator

from tms_config import reasons
from tms_config.extending import extended
from tms_reason.reason import Reason
from tms_reason.validation import Wrong

Backend = Literal["sim", "opera", "physx"]
Kind = Literal["backhoe", "crawler_dump", "bulldozer"]  # the shape that the console draws
DRIVE = "drive"  # key of the tracks in `response`
NAME = r"^[a-z][a-z0-9_]*$"
# Action that brings one joint to an angle -> the names of this joint in the models.
TURNED = {"set_dump_angle": ("vessel_pin_joint", "dump_joint"), "set_swing_angle": ("rotate_joint",)}


class Settings(BaseModel):
    """Base of all configuration: frozen, and unknown keys are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Joint(Settings):
    """Limits of one joint; `min` and `max` are absent for a joint that turns for ever."""

    min: float | None = None  # rad
    max: float | None = None  # rad
    velocity: float = Field(gt=0)  # rad/s
    acceleration: float = Field(gt=0)  # rad/s^2
    jerk: float = Field(gt=0)  # rad/s^3
    passive: bool = False  # no command moves it, as for a virtual tool frame; the gateway still watches it

    def violation(self, angle: float) -> Reason | None:
        """Which bound `angle` [rad] breaks, or None."""
        if self.min is not None and angle < self.min - 1e-6:
            return reasons.BelowLimit(angle, self.min)
        if self.max is not None and angle > self.max + 1e-6:
            return reasons.AboveLimit(angle, self.max)
        return None


class Origin(Settings):
    """The place of a joint on its parent link (URDF joint origin) and its axis."""

    parent: str
    child: str
    xyz: tuple[float, float, float]  # m
    pitch: float = 0.0  # rad
    axis: Literal["x", "y", "z"] = "y"


class Box(Settings):
    """A box along the axes of a frame, or of the frame turned about y by `pitch`."""

    min: tuple[float, float, float]  # m
    max: tuple[float, float, float]  # m
    pitch: float = 0.0  # rad


class Bucket(Settings):
    """An excavator's bucket: its inner section in the x-z plane of its link, the same over its width."""

    link: str
    section: tuple[tuple[float, float], ...] = Field(min_length=3)  # m; convex, from the rear lip to the cutting edge
    width: float = Field(gt=0)  # m, inside
    force: float = Field(gt=0)  # N at the cutting edge that arm and bucket can bring up
    origin: str = Field(min_length=1)  # where the figures come from

    @model_validator(mode="after")
    def _convex(self) -> "Bucket":
        at = self.section
        corners = zip(at, (*at[1:], at[0]), (*at[2:], *at[:2]), strict=True)
        if not all((b[0] - a[0]) * (c[1] - b[1]) < (b[1] - a[1]) * (c[0] - b[0]) for a, b, c in corners):
            raise Wrong(reasons.NotConvex(), "section")
        return self


class Vessel(Settings):
    """A carrier's vessel, the inside as a box of its link; it tips over the end at the least x."""

    link: str
    min: tuple[float, float, float]  # m
    max: tuple[float, float, float]  # m
    heaped: float = Field(gt=0)  # m3 that it holds
    origin: str = Field(min_length=1)  # where the figures come from


class Blade(Settings):
    """A bulldozer's blade: its lower edge, across its link."""

    link: str
    edge: tuple[float, float]  # m, x and z
    width: float = Field(gt=0)  # m
    force: float = Field(gt=0)  # N that the tracks can push it with
    origin: str = Field(min_length=1)  # where the figures come from


class Tracks(Settings):
    """Where two tracks touch the ground, in base_link at z = 0."""

    rear: float  # m, x
    front: float  # m, x
    gauge: float = Field(gt=0)  # m from middle to middle
    width: float = Field(gt=0)  # m, of one
    origin: str = Field(min_length=1)  # where the figures come from


class Solid(Settings):
    """A part of what a machine looks like, for eyes only: an outline on its link, the same over each span of y."""

    link: str
    role: Literal["track", "body", "arm", "tool"]
    y: tuple[tuple[float, float], ...] = Field(min_length=1)  # m, from and to
    outline: tuple[tuple[float, float], ...] = Field(min_length=3)  # m, x and z


class Drive(Settings):
    """Limits of travel for the navigation and the stand-in."""

    velocity: float = Field(gt=0)  # m/s
    acceleration: float = Field(gt=0)  # m/s^2
    turn_velocity: float = Field(gt=0)  # rad/s
    turn_acceleration: float = Field(gt=0)  # rad/s^2


class Still(Settings):
    """When the machine counts as standing."""

    velocity: float = Field(gt=0)  # rad/s, every joint below it ...
    linear: float = Field(gt=0)  # m/s, ... and, where a source reports the base, the base below this ...
    angular: float = Field(gt=0)  # rad/s, ... and this ...
    seconds: float = Field(gt=0)  # s, ... for this long, counted from the end of the dead time
    origin: str = Field(min_length=1)  # where the figures come from


class Response(Settings):
    """The answer of a joint, or of the tracks, to a command: none for the dead time, then a first-order lag."""

    dead_time: float = Field(ge=0)  # s
    lag: float = Field(gt=0)  # s, time constant
    droop: float = 0.0  # rad, how far a joint stays short of a commanded angle, by its sign: gravity pulls at it
    origin: str = Field(min_length=1)  # where the figures come from


SourceName = Literal["joint_states", "odom", "pose", "imu"]
Stamps = Literal["utc", "since_start", "none"]


class Source(Settings):
    """Properties of one topic that reports the machine's motion."""

    period: float = Field(gt=0, le=0.25)  # s between messages; a slower source cannot prove that a machine stands
    stamps: Stamps  # origin of the header's time; `none`: it is empty, and the arrival is used
    frozen_after: float = Field(gt=0)  # s with bitwise equal values while a goal should change them
    origin: str = Field(min_length=1)  # where the figures come from
    resolution: float = Field(ge=0, default=0.0)  # rad or m by which positions jitter while it stands
    message: Literal["PoseStamped", "Odometry"] = "PoseStamped"  # type of `pose`


class Border(Settings):
    """Names at the machine's own border, relative to its namespace; an absent name: the machine lacks it."""

    # actions; the gateway serves each under /<machine>/rc/<key>, the trajectory as follow_joint_trajectory
    trajectory: str | None = None
    navigate_to_pose: str | None = None
    navigate_through_poses: str | None = None
    follow_waypoints: str | None = None
    follow_path: str | None = None
    set_dump_angle: str | None = None
    set_swing_angle: str | None = None
    set_bulldozer_blade: str | None = None
    compute_path_to_pose: str | None = None  # moves nothing, so the gateway does not serve it
    # topics
    joint_states: str | None = None
    odom: str | None = None
    pose: str | None = None  # of the base in `map`; absent: /tf tells its place
    imu: str | None = None
    sources: dict[SourceName, Source] = {}  # each of the four topics above that is present has its entry
    cmd_vel: str | None = None
    emg_stop: str | None = None
    emg_stop_at_once: bool = False  # emg_stop acts without the machine's dead time
    manual: str | None = None  # std_msgs/Bool, true while a person drives the machine by its own levers
    # std_msgs/String of the mode lamp: automatic, manual, stopped or fault; a lamp that hears nothing shows fault.
    lamp: str | None = None
    controller: Literal["ours", "theirs"] = "theirs"  # who serves the actions and commands the drives
    response: dict[str, Response] = {}  # where drives answer otherwise than the model's
    joint_cmd: str | None = None  # com3_msgs/JointCmd, published by the controller
    joint_angles: dict[str, str] = {}  # joint -> topic of std_msgs/Float64 [rad], for some simulated machines
    dump_returns: bool = False  # a goal for the vessel is a whole cycle there: it tips, waits, and comes back by itself
    # frames; {name} is the machine, so that two machines of one model never share a frame
    frame_prefix: str = "{name}/"
    base_frame: str = "{name}/base_link"  # below `map` in /tf: the place of the machine
    joints: dict[str, str] = {}  # joint of the model -> its name at this border, where they differ
    initial: dict[str, float] = {}  # rad, joint -> where it starts, if not as in the model

    @model_validator(mode="after")
    def _sources_known(self) -> "Border":
        for name in get_args(SourceName):
            if getattr(self, name) and name not in self.sources:
                raise Wrong(reasons.NoSourceFacts(), "sources", name)
            if name in self.sources and not getattr(self, name):
                raise Wrong(reasons.NoTopic(name), "sources", name)
        return self


class SubtaskUse(Settings):
    """The subtask file for an action name, and the fixed inputs of this variant."""

    run: str = Field(pattern=NAME)
    inputs: dict[str, Any] = {}
    max_age: float = Field(ge=0, default=0.0)  # s that a dynamic record may be old; 0: the record's own limit
    example: str | None = None  # a record of configs/parameters that shows its use; the contract test runs it


class MachineModel(Settings):
    """A type of machine: configs/machines/<model>.yaml."""

    kind: Kind
    planner: str | None = Field(default=None, pattern=NAME)  # folder of services/tms_rp/kinds; absent: plans nothing
    joints: dict[str, Joint]
    geometry: dict[str, Origin]
    footprint: dict[str, Box] = {}  # boxes that other machines must not touch, base_link
    shapes: dict[str, Box] = {}  # link -> its body in its own frame, for the planner
    bucket: Bucket | None = None
    vessel: Vessel | None = None
    blade: Blade | None = None
    tracks: Tracks | None = None  # without them it leaves the ground as it is
    solids: tuple[Solid, ...] = ()
    drive: Drive | None = None
    response: dict[str, Response] = {}  # joint, or `drive` for the tracks -> how it answers commands
    initial: dict[str, float] = {}  # rad, start pose of its stand-in
    start: tuple[float, float, float] = (0.0, 0.0, 0.0)  # x m, y m, yaw rad, simulator, frame map
    still: Still
    borders: dict[Backend, Border]
    subtasks: dict[str, SubtaskUse | str] = {}

    @property
    def driven(self) -> list[str]:
        """The joints that commands move."""
        return [name for name, joint in self.joints.items() if not joint.passive]

    def subtask(self, action: str) -> SubtaskUse:
        """The use for an action name; the short form `action: file` is completed."""
        use = self.subtasks[action]
        return SubtaskUse(run=use) if isinstance(use, str) else use

    def responses(self, border: Border) -> dict[str, Response]:
        """How joints and tracks answer commands at a border."""
        return {**self.response, **border.response}

    def turned(self, action: str) -> str | None:
        """The joint that an action like set_dump_angle moves; None if the model has none."""
        return next((name for name in TURNED.get(action, ()) if name in self.joints), None)

    @model_validator(mode="before")
    @classmethod
    def _borders_extended(cls, data: Any) -> Any:
        return {**data, "borders": extended(data["borders"])} if isinstance(data.get("borders"), dict) else data

    @model_validator(mode="after")
    def _names_fit(self) -> "MachineModel":
        links = {origin.child for origin in self.geometry.values()} | {"base_link"}
        tools = [tool.link for tool in (self.bucket, self.vessel, self.blade, *self.solids) if tool]
        strange = [name for name in (*self.shapes, *tools) if name not in links]
        strange += [name for name in (*self.initial, *self._border_joints()) if name not in self.joints]
        if strange:
            raise Wrong(reasons.NoSuchLink(strange[0]))
        return self

    @model_validator(mode="after")
    def _response_known(self) -> "MachineModel":
        """Refuse a model without dead time and lag: a stop could not be proven."""
        moved = self.driven + [DRIVE] * (self.drive is not None)
        for name in moved:
            if name not in self.response:
                raise Wrong(reasons.NoResponse(name), "response")
        strange = [name for name in self.response if name not in moved]
        if strange:
            raise Wrong(reasons.NoMover(strange[0]), "response", strange[0])
        return self

    @model_validator(mode="after")
    def _links_hang_together(self) -> "MachineModel":
        known = {"base_link"}
        for joint, origin in self.geometry.items():
            if origin.parent not in known:
                raise Wrong(reasons.NoParent(origin.parent), "geometry", joint)
            known.add(origin.child)
        return self

    def _border_joints(self) -> list[str]:
        return [name for one in self.borders.values() for name in (*one.joints, *one.joint_angles, *one.initial)]
