"""Model of configs/site.yaml and configs/sites/*.yaml."""

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AnyHttpUrl, Field, ValidationError, field_validator, model_validator

from tms_config.models import NAME, Backend, Settings
from tms_config.reasons import FormNotSaid, HalfALogin, NoUri, PasswordInUri, TwoPlanners, UserTwice
from tms_reason.validation import Wrong, problems

ServiceName = Annotated[str, Field(pattern=r"^(/[A-Za-z_][A-Za-z0-9_]*)+$", max_length=200)]
ServiceType = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*/[A-Z][A-Za-z0-9]*$")]  # pkg/Type
Role = Literal["cps", "scheduler", "machine", "sensing", "sim"]
ROLES: tuple[Role, ...] = ("cps", "scheduler", "machine", "sensing", "sim")


class Service(Settings):
    """A service of the site, and the role of the PC that runs it."""

    role: Role = "cps"


class Bridge(Service):
    """The ROS-TCP endpoint that OperaSim-PhysX connects to."""

    role: Role = "sim"
    port: int = Field(ge=1024, le=65535, default=10000)
    bind: str = "127.0.0.1"  # a client may publish sensor data: open it to the simulator's network only
    joint_cmd: Literal["plain", "control_type"] = "plain"  # the simulator's layout of com3_msgs/JointCmd
    message_limit: int = Field(ge=1024, le=64 * 1024 * 1024, default=4 * 1024 * 1024)  # bytes a message
    clock: bool = False  # publish the simulator's time as /clock
    trial: str | None = Field(default=None, pattern=r"^[A-Za-z]+$")  # scene of a stand-in that is started in its place
    calls: dict[ServiceName, ServiceType] = Field(default_factory=dict)  # ROS services that a client may call
    offers: dict[ServiceName, ServiceType] = Field(default_factory=dict)  # services that a client may serve


class MachineUse(Settings):
    """One real machine of the site."""

    model: str = Field(pattern=NAME)
    role: Role = "machine"
    start: tuple[float, float, float] | None = None  # x m, y m, yaw rad: start of its stand-in, if not the model's
    hardware: dict[str, Any] = Field(default_factory=dict)  # tms_hardware/settings.py reads it
    # NavSatFix of its GNSS, below its name, if it has RTK
    fix: str | None = Field(pattern=r"^[A-Za-z][A-Za-z0-9_/]*$", default=None)


class Ports(Settings):
    """The first of the consecutive metrics ports, and the fixed ports. All are on `bind`."""

    metrics: int = Field(ge=1024, le=65000, default=9410)
    console: int = Field(ge=1024, le=65535, default=8080)
    store: int = Field(ge=1024, le=65535, default=27117)
    groot: int = Field(ge=1024, le=65000, default=1666)  # first run: Groot 1 here and +1, Groot 2 +2; next run +10


def _holds_password(uri: str) -> bool:
    """Whether a URI names a user with a password."""
    return ":" in uri.partition("://")[2].rpartition("@")[0]


class Store(Settings):
    """The database's store: `embedded` is the demo's own; `mongodb` is a server that the site runs.

    The site file never holds the password: it is in `password_file`, or in a whole URI from TMS_MONGODB_URI or from the
    file that TMS_MONGODB_URI_FILE names; user and TLS of the site file are then ignored.
    """

    kind: Literal["embedded", "mongodb"] = "embedded"
    uri: str | None = None  # mongodb://db1,db2,db3/?replicaSet=rs0
    user: str | None = Field(min_length=1, default=None)
    password_file: Path | None = None
    tls_ca: Path | None = None  # PEM of the authority that signed the server's certificate; its use means TLS
    tls_certificate: Path | None = None  # PEM of our own certificate and key, where the server asks for one
    database: str = Field(pattern=r"^[A-Za-z][A-Za-z0-9_-]*$", default="rostmsdb")
    history_days: int | None = Field(ge=1, default=365)  # days for which ended runs and events are kept; null: for ever
    machine_state_days: int | None = Field(ge=1, default=None)  # the same for machine_pose and machine_joints
    work_days: int | None = Field(ge=1, default=None)  # the same for cycles of work
    ground_days: int | None = Field(ge=1, default=None)  # the same for snapshots of the ground; the newest one stays
    recording_days: int | None = Field(ge=1, default=30)  # the same for what machines did, and hourly grounds

    @model_validator(mode="after")
    def _whole(self) -> "Store":
        if _holds_password(self.uri or ""):
            raise Wrong(PasswordInUri(), "uri")
        if (self.user is None) != (self.password_file is None):
            raise Wrong(HalfALogin())
        if self.uri is None and (self.user or self.tls_ca or self.tls_certificate):
            raise Wrong(NoUri())
        if self.user is not None and "@" in (self.uri or ""):
            raise Wrong(UserTwice(), "user")
        return self


class Fault(Settings):
    """Faults of a stand-in; times are seconds of the machine, and 0 is off.

    `zero_velocity` to `back_in_time` falsify its reports; `coast` to `ignore_emg_stop` change its motion.
    """

    stall: float | None = Field(ge=0, default=None)  # s in motion after which the machine stands; the goal goes on
    die: float | None = Field(ge=0, default=None)  # s in motion after which the process ends
    late: float = Field(ge=0, default=0.0)  # s from every command to its effect
    drift: float = 0.0  # m/s or rad/s that the machine creeps while it should stand
    refuse: tuple[str, ...] = ()  # actions, by their key under borders:, that refuse goals
    drop_feedback: bool = False
    miss: tuple[int, ...] = ()  # waypoints, from 0, that follow_waypoints cannot reach
    zero_velocity: bool = False  # every velocity is reported as 0
    frozen_stamp: bool = False  # the last message is repeated with its old stamp
    replay: bool = False  # the last 2 s are repeated with new stamps
    mute: tuple[str, ...] = ()  # joints that are left out
    second_publisher: bool = False  # another publisher reports at 60 Hz that the machine stands
    jump: float = 0.0  # rad, m: offset of every reported position
    nan: bool = False  # every number is reported as NaN
    back_in_time: float = Field(ge=0, default=0.0)  # s by which stamps jump back
    coast: float = Field(ge=0, default=0.0)  # s that its motion goes on after every order to stop
    dead_time: float = Field(ge=0, default=0.0)  # s in addition to the model's dead time
    creep: float = 0.0  # m/s or rad/s of a motion that begins after 3 s of stand-still
    ignore_cancel: bool = False
    ignore_emg_stop: bool = False
    hardware: tuple[str, ...] = ()  # sources of `hardware:` that tell what forbids motion; a counter stands still
    hardware_mute: tuple[str, ...] = ()  # those that tell nothing


class Scanner(Settings):
    """A stand-in of terrain sensing, on a mast or a machine; its points are on /<name>/points."""

    machine: str | None = None  # that carries it; else it stands at x, y
    x: float = 0.0  # m, map
    y: float = 0.0  # m, map
    height: float = Field(gt=0, default=4.0)  # m, of its eye above the ground
    range: float = Field(gt=0, le=60, default=20.0)  # m
    noise: float = Field(ge=0, default=0.01)  # m, standard deviation
    hz: float = Field(gt=0, le=5, default=1.0)


class Walk(Settings):
    """Somebody whom a tracker sees: to the end of a path and back again, for ever."""

    path: tuple[tuple[float, float], ...] = Field(min_length=1)  # m, map
    speed: float = Field(ge=0, le=20, default=1.2)  # m/s
    after: float = Field(ge=0, default=0.0)  # s until the first step


class TrackerStandIn(Settings):
    """What a tracker of sensing.yaml is told by its stand-in; times count from its last change."""

    walks: tuple[Walk, ...] = ()
    open: bool = False  # of a gate
    silent: bool = False  # a fault: it says nothing


class Simulator(Settings):
    """How the stand-ins of the site move."""

    speed: float = Field(gt=0, le=100, default=1.0)  # times real time
    seed: int = 0
    response: Literal["machine", "ideal"] = "machine"  # ideal: no dead time, no lag; for sites that try no stops
    names: Backend = "sim"  # whose names and joint names the stand-ins use
    faults: dict[str, Fault] = Field(default_factory=dict)  # machine -> its faults from the start
    scanners: dict[Annotated[str, Field(pattern=NAME)], Scanner] = Field(default_factory=dict)  # of a site with ground
    trackers: dict[Annotated[str, Field(pattern=NAME)], TrackerStandIn] = Field(default_factory=dict)


class Groot(Settings):
    """Access for Groot to running trees; its protocols have no passwords."""

    bind: str = "127.0.0.1"


class Files(Settings):
    """Certificate and key in PEM."""

    certificate: Path
    key: Path


class Console(Settings):
    """Access to the console; see `tms user --help`."""

    users: Path | None = None  # file that `tms user` writes; absent: only this PC, without login
    tls: Files | None = None
    # Tasks that nodes of the C++ system's version 6 see in /permissionrequest. With any, they may start trees:
    # /urpermission starts these, /task_sequence the trees that it brings. ROS does not tell who asks.
    buttons: tuple[Annotated[int, Field(ge=1)], ...] = ()
    names: tuple[str, ...] = ()  # further names under which browsers reach it, e.g. site-pc.example
    prometheus: AnyHttpUrl | None = None  # tells alerts that only metrics show, e.g. http://127.0.0.1:9090


class OnLoss(Settings):
    """Reactions to the loss of a process."""

    retries: int = Field(ge=0, le=10, default=2)  # times that a leaf sends its goal again
    frozen: float = Field(ge=0, default=20.0)  # s without an answer after which tms:host restarts a process; 0: never


class LogSettings(Settings):
    """Logs of the processes; supervisord keeps and rotates the files."""

    level: Literal["DEBUG", "INFO", "WARNING", "ERROR"] = "INFO"
    json_lines: bool = False  # a JSON object a line, for Loki


class Pc(Settings):
    """One PC of the site; its name is its key."""

    address: str = Field(min_length=1)  # IP address or name, for the other PCs
    roles: tuple[Role, ...] = ()  # default: the role that is the PC's name
    machines: tuple[str, ...] = ()  # whose processes (tasks) run here; default: those that no other PC has


class Peer(Settings):
    """Nodes of the C++ system that share the names of a machine."""

    # Their form of LeafNodeBase: version 5; 6 with previous_target_record_name only; 6 with all three inputs.
    leaf: Literal["v5", "v6a", "v6b"]
    motions: bool = False  # with version 6: the machine's motions also under the names that its primitives call
    # theirs: their planner plans the arm's motions in place of ours, which checks and executes the plans.
    planner: Literal["ours", "theirs"] = "ours"


class Forms(Settings):
    """The forms of definitions that version 6 of the C++ system has in several; one definition, one form in a site."""

    TmsRpExcavator: Literal["plan", "plans"] | None = None  # its field for what is executed; none: it is not spoken
    TmsdbGetData: Literal["param_type", "both"] | None = None  # in place of flgorparam, or beside it; none: version 5


class Network(Settings):
    """Discovery between processes of different PCs."""

    # server: for network segments without multicast. After the server was killed, new processes may stay unfound for
    # half a minute, so it is not the default, although it is cheaper for many processes.
    discovery: Literal["multicast", "server"] = "multicast"
    port: int = Field(ge=1024, le=65535, default=11811)  # of the discovery server, on the PC with the role cps


def roles(name: str, pc: Pc) -> tuple[Role, ...]:
    """The roles of a PC."""
    return pc.roles or tuple(role for role in ROLES if role == name)


class SiteFile(Settings):
    """The content of site.yaml."""

    name: str = Field(pattern=NAME)
    domain: int = Field(ge=0, le=101)  # ROS_DOMAIN_ID
    bind: str = "127.0.0.1"
    backend: Backend = "sim"
    ports: Ports = Ports()
    store: Store = Store()
    sim: Simulator = Simulator()
    on_loss: OnLoss = OnLoss()
    groot: Groot = Groot()
    console: Console = Console()
    log: LogSettings = LogSettings()
    pcs: dict[str, Pc] = Field(default_factory=dict)  # none: everything on this one
    network: Network = Network()
    sensing: str | None = None  # file of the sensing inputs, beside this one; default: configs/sensing.yaml
    services: dict[str, Service]
    machines: dict[Annotated[str, Field(pattern=NAME)], MachineUse] = Field(default_factory=dict)
    peers: dict[str, Peer] = Field(default_factory=dict)  # machine -> nodes of the C++ system beside ours
    forms: Forms = Forms()  # of what they speak
    ground: dict[str, Any] | None = None  # tms_ground/settings.py reads it

    @field_validator("services", mode="before")
    @classmethod
    def _bridge(cls, services: Any) -> Any:
        """Parse the bridge's settings, which other services do not have."""
        if not (isinstance(services, dict) and isinstance(services.get("if"), dict)):
            return services
        try:
            return {**services, "if": Bridge.model_validate(services["if"])}
        except ValidationError as error:
            keys, reason = next(problems(error))
            raise Wrong(reason, "if", *keys) from error

    @model_validator(mode="after")
    def _one_planner(self) -> "SiteFile":
        for machine, peer in self.peers.items():
            if peer.planner == "theirs" and peer.motions:
                raise Wrong(TwoPlanners(), "peers", machine, "planner")
            if peer.planner == "theirs" and self.forms.TmsRpExcavator is None:
                raise Wrong(FormNotSaid("TmsRpExcavator"), "peers", machine, "planner")
        return self

    @property
    def names(self) -> Backend:
        """The backend whose border names are valid: stand-ins may use those of another backend."""
        return self.sim.names if self.backend == "sim" else self.backend
