"""Reads configs/ into frozen models; an unknown key is an error that names file and key."""

import importlib.metadata
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeVar

import yaml
from pydantic import Field, ValidationError, field_validator, model_validator

from tms_core import pcs, store_address
from tms_core.errors import ConfigError
from tms_core.models import (
    NAME,
    Backend,
    Border,
    Box,
    Drive,
    Joint,
    MachineModel,
    Origin,
    Settings,
    Still,
    SubtaskUse,
)
from tms_core.pcs import Network, Pc, Role

__all__ = [
    "CONFIGS", "PROJECT", "Backend", "Border", "Box", "Bridge", "Drive", "Fault", "Joint", "MachineModel", "Origin",
    "Role", "Settings", "Site", "SiteFile", "Still", "SubtaskUse", "explain", "load_site", "parse", "read_yaml",
    "version",
]  # fmt: skip

PROJECT = Path(__file__).resolve().parents[2]
CONFIGS = PROJECT / "configs"


class Service(Settings):
    role: Role = "cps"


class Bridge(Service):
    """The ROS-TCP endpoint that OperaSim-PhysX connects to."""

    role: Role = "sim"
    port: int = Field(ge=1024, le=65535, default=10000)
    bind: str = "127.0.0.1"  # whoever reaches it may publish sensor data: open it to the simulator's network only
    joint_cmd: Literal["plain", "control_type"] = "plain"  # layout of com3_msgs/JointCmd that the simulator knows
    message_limit: int = Field(ge=1024, le=64 * 1024 * 1024, default=4 * 1024 * 1024)  # bytes a message


class MachineUse(Settings):
    """One real machine of the site."""

    model: str = Field(pattern=NAME)
    role: Role = "machine"
    start: tuple[float, float, float] | None = None  # x m, y m, yaw rad: where its stand-in begins, if not as the model


class Ports(Settings):
    """First of the consecutive metrics ports, and the fixed ones. All on `bind`."""

    metrics: int = Field(ge=1024, le=65000, default=9410)
    console: int = Field(ge=1024, le=65535, default=8080)
    store: int = Field(ge=1024, le=65535, default=27117)
    groot: int = Field(
        ge=1024, le=65000, default=1666
    )  # of the first run: Groot 1 here and +1, Groot 2 +2; next run +10


class Store(Settings):
    """`embedded` is the demo's own store; `mongodb` is a server that the site runs.

    A password never stands here: it is in `password_file`, or in a whole URI that comes from TMS_MONGODB_URI or the
    file that TMS_MONGODB_URI_FILE names; what is here about user and TLS then does not count.
    """

    kind: Literal["embedded", "mongodb"] = "embedded"
    uri: str | None = None  # mongodb://db1,db2,db3/?replicaSet=rs0
    user: str | None = Field(min_length=1, default=None)
    password_file: Path | None = None
    tls_ca: Path | None = None  # PEM of the authority that signed the server's certificate; its use means TLS
    tls_certificate: Path | None = None  # PEM of our own certificate and key, where the server asks for one
    database: str = Field(pattern=r"^[A-Za-z][A-Za-z0-9_-]*$", default="rostmsdb")
    history_days: int | None = Field(ge=1, default=365)  # that an ended run and its events stay; null: for ever
    machine_state_days: int | None = Field(ge=1, default=None)  # the same for machine_pose and machine_joints

    @model_validator(mode="after")
    def _whole(self) -> "Store":
        if store_address.holds_password(self.uri or ""):
            raise ValueError("uri holds a password: write user and password_file instead, or use TMS_MONGODB_URI_FILE")
        if (self.user is None) != (self.password_file is None):
            raise ValueError("user and password_file go together: give both or none")
        if self.uri is None and (self.user or self.tls_ca or self.tls_certificate):
            raise ValueError("user, password_file and TLS need the uri of a MongoDB: add it")
        if self.user is not None and "@" in (self.uri or ""):
            raise ValueError("the user stands in uri and in user: keep the latter")
        return self


class Fault(Settings):
    """What goes wrong in a stand-in; times are seconds of the machine, 0 is off."""

    stall: float | None = Field(ge=0, default=None)  # s in motion after which the machine stands and the goal goes on
    die: float | None = Field(ge=0, default=None)  # s in motion after which the process is gone
    late: float = Field(ge=0, default=0.0)  # s from every command to its effect
    drift: float = 0.0  # m/s or rad/s that the machine creeps while it should stand
    refuse: tuple[str, ...] = ()  # actions, by their key under borders:, that take no goal
    drop_feedback: bool = False
    miss: tuple[int, ...] = ()  # waypoints, from 0, that follow_waypoints cannot reach


class Simulator(Settings):
    speed: float = Field(gt=0, le=100, default=1.0)  # times real time
    seed: int = 0
    names: Backend = "sim"  # whose names and joint names the stand-ins use
    faults: dict[str, Fault] = Field(default_factory=dict)  # machine -> what goes wrong from the start


class Groot(Settings):
    """Who may look at running trees with Groot: its protocols know no passwords."""

    bind: str = "127.0.0.1"


class Files(Settings):
    """Certificate and key in PEM."""

    certificate: Path
    key: Path


class Console(Settings):
    """Who may use the console; see `tms user --help`."""

    users: Path | None = None  # file that `tms user` writes; absent: only this PC, without asking who
    tls: Files | None = None
    names: tuple[str, ...] = ()  # further names under which browsers reach it, e.g. site-pc.example


class OnLoss(Settings):
    """What happens when a process is lost."""

    retries: int = Field(ge=0, le=10, default=2)  # times that a leaf sends its goal again
    frozen: float = Field(ge=0, default=20.0)  # s without an answer after which tms:host restarts a process; 0: never


class Log(Settings):
    """How processes log; supervisord keeps and rotates the files."""

    level: Literal["DEBUG", "INFO", "WARNING", "ERROR"] = "INFO"
    json_lines: bool = False  # a JSON object a line, for Loki


class SiteFile(Settings):
    """What site.yaml may hold."""

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
    log: Log = Log()
    pcs: dict[str, Pc] = Field(default_factory=dict)  # none: everything on this one
    network: Network = Network()
    sensing: str | None = None  # file of the sensing inputs, beside this one; default: configs/sensing.yaml
    services: dict[str, Service]
    machines: dict[str, MachineUse] = Field(default_factory=dict)

    @field_validator("services", mode="before")
    @classmethod
    def _bridge(cls, services: Any) -> Any:
        """The bridge has settings of its own."""
        if not (isinstance(services, dict) and isinstance(services.get("if"), dict)):
            return services
        try:
            return {**services, "if": Bridge.model_validate(services["if"])}
        except ValidationError as error:
            raise ValueError(f"if.{explain(error)}") from error

    @property
    def names(self) -> Backend:
        """Whose border names hold here: stand-ins may use those of another backend."""
        return self.sim.names if self.backend == "sim" else self.backend


@dataclass(frozen=True)
class Site:
    """A checked site: its file, the machine models it uses, and where its state lives."""

    path: Path
    file: SiteFile
    models: dict[str, MachineModel]
    state: Path
    pc: str | None = None  # which of `pcs:` this one is

    @property
    def name(self) -> str:
        return self.file.name

    @property
    def domain(self) -> int:
        return self.file.domain

    @property
    def store_uri(self) -> str:
        """URI of the store, with its password: never log it.

        Raises:
            ConfigError: a file with a secret cannot be read.
        """
        if given := _secret("TMS_MONGODB_URI"):
            return given
        if given := self.file.store.uri:
            return store_address.address(self.file.store, given, self.path)
        return f"mongodb://127.0.0.1:{self.file.ports.store}/?directConnection=true"

    @property
    def embedded_store(self) -> bool:
        return self.file.store.kind == "embedded" and not {"TMS_MONGODB_URI", "TMS_MONGODB_URI_FILE"} & set(os.environ)

    @property
    def bridge(self) -> Bridge:
        """Settings of the ROS-TCP endpoint.

        Raises:
            ConfigError: the site has none.
        """
        found = self.file.services.get("if")
        if not isinstance(found, Bridge):
            raise ConfigError(f"{self.path}: services: there is no 'if'")
        return found

    def model_of(self, machine: str) -> MachineModel:
        """The model of a machine instance.

        Raises:
            ConfigError: the site has no such machine.
        """
        use = self.file.machines.get(machine)
        if use is None:
            known = ", ".join(self.file.machines) or "none"
            raise ConfigError(f"{self.path}: no machine '{machine}' under machines: (there: {known})")
        return self.models[use.model]

    def border(self, machine: str) -> Border:
        """Border names of a machine for this site's backend, with the machine's own name filled in."""
        border = self.model_of(machine).borders[self.file.names]
        own = {key: getattr(border, key).format(name=machine) for key in ("frame_prefix", "base_frame")}
        return border.model_copy(update=own)

    def start_of(self, machine: str) -> tuple[float, float, float]:
        """Where a stand-in begins: x [m], y [m], yaw [rad] in map."""
        return self.file.machines[machine].start or self.model_of(machine).start


def _secret(name: str) -> str | None:
    """Value of a variable, or of the file that NAME_FILE names, as containers and systemd hand out secrets."""
    path = os.environ.get(f"{name}_FILE")
    if name in os.environ or not path:
        return os.environ.get(name)
    try:
        return Path(path).read_text(encoding="utf-8").strip()
    except OSError as error:
        raise ConfigError(f"{name}_FILE: {path}: cannot be read ({error.strerror})") from error


def version() -> str:
    """Version of this project, as it is installed."""
    return importlib.metadata.version("ros2-tms")


T = TypeVar("T", bound=Settings)


class _Loader(yaml.CSafeLoader):
    """YAML that refuses a key given twice; PyYAML would keep the last one silently. Ten times as fast as SafeLoader."""


def _mapping(loader: _Loader, node: yaml.MappingNode) -> dict[Any, Any]:
    seen: dict[Any, Any] = {}
    for key_node, value_node in node.value:
        key = loader.construct_object(key_node, deep=True)
        if key in seen:
            raise yaml.MarkedYAMLError(problem=f"key '{key}' is there twice", problem_mark=key_node.start_mark)
        seen[key] = loader.construct_object(value_node, deep=True)
    return seen


_Loader.add_constructor(yaml.resolver.BaseResolver.DEFAULT_MAPPING_TAG, _mapping)


def read_yaml(path: Path) -> Any:
    """Parsed content of a YAML file.

    Raises:
        ConfigError: it cannot be read or is no YAML.
    """
    try:
        return yaml.load(path.read_text(encoding="utf-8"), _Loader)  # a safe loader
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise ConfigError(f"{path}: is not UTF-8 text") from error
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 0
        raise ConfigError(f"{path}:{line}: {error.problem}") from error
    except yaml.YAMLError as error:  # a character that no YAML may hold
        raise ConfigError(f"{path}: {str(error).splitlines()[0]}") from error


def parse(path: Path, model: type[T]) -> T:
    """A settings file as its model.

    Raises:
        ConfigError: names the file, the key and what is wrong with it.
    """
    data = read_yaml(path)
    if not isinstance(data, dict):
        raise ConfigError(f"{path}: must hold keys and values")
    try:
        return model.model_validate(data)
    except ValidationError as error:
        raise ConfigError(f"{path}: {explain(error)}") from error


def explain(error: ValidationError) -> str:
    """First problem of a validation, as `key: what`; says how many more there are."""
    first = error.errors()[0]
    key = ".".join(str(part) for part in first["loc"])
    message = "unknown key" if first["type"] == "extra_forbidden" else first["msg"].removeprefix("Value error, ")
    more = error.error_count() - 1
    return (f"{key}: " if key else "") + message + (f" (and {more} more)" if more else "")


def site_path(chosen: str | None = None) -> Path:
    """File of the chosen site: a path, a name below configs/sites/, or the demo."""
    chosen = chosen or os.environ.get("TMS_SITE") or ""
    if not chosen:
        return CONFIGS / "site.yaml"
    if chosen.endswith((".yaml", ".yml")) or "/" in chosen:
        return Path(chosen).resolve()
    return CONFIGS / "sites" / f"{chosen}.yaml"


def load_site(chosen: str | None = None) -> Site:
    """Read and check a site and every machine model it uses.

    Raises:
        ConfigError: names the file and the key.
    """
    path = site_path(chosen)
    file = parse(path, SiteFile)
    if "ROS_DOMAIN_ID" in os.environ:
        file = file.model_copy(update={"domain": _domain(os.environ["ROS_DOMAIN_ID"])})
    models: dict[str, MachineModel] = {}
    for machine, use in file.machines.items():
        if use.model not in models:
            models[use.model] = _model(path, machine, use.model, file.names)
    _check_machines(path, file, models)
    pcs.check(path, file)
    state = Path(os.environ.get("TMS_STATE") or PROJECT / ".state" / file.name).resolve()
    return Site(path, file, models, state, pcs.chosen(path, file, state))


def _check_machines(path: Path, file: SiteFile, models: dict[str, MachineModel]) -> None:
    """Refuse two machines in one frame and faults of machines that are not there."""
    frames: dict[str, str] = {}
    for machine, use in file.machines.items():
        prefix = models[use.model].borders[file.names].frame_prefix.format(name=machine)
        if prefix in frames:
            raise ConfigError(
                f"{path}: {frames[prefix]} and {machine} would share their frames ('{prefix}base_link'): "
                f"give borders.{file.names}.frame_prefix of configs/machines/{use.model}.yaml a {{name}}"
            )
        frames[prefix] = machine
    for machine in file.sim.faults:
        if machine not in file.machines:
            raise ConfigError(f"{path}: sim.faults.{machine}: no such machine (there: {', '.join(file.machines)})")


def _domain(text: str) -> int:
    if not text.isdigit() or int(text) > 101:
        raise ConfigError(f"ROS_DOMAIN_ID is '{text}': use a number from 0 to 101, or unset it")
    return int(text)


def _model(site: Path, machine: str, name: str, backend: Backend) -> MachineModel:
    path = CONFIGS / "machines" / f"{name}.yaml"
    if not path.exists():
        known = ", ".join(sorted(p.stem for p in path.parent.glob("*.yaml")))
        raise ConfigError(f"{site}: machines.{machine}.model: no model '{name}' (there: {known})")
    model = parse(path, MachineModel)
    if backend not in model.borders:
        raise ConfigError(f"{path}: borders: nothing for backend '{backend}', which {site} uses")
    return model
