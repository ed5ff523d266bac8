"""Machine and scene files. Angles in the files are in degrees, as the prefabs have them."""

import math
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Literal, TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from operasim.drive import DriveModel
from operasim.tracks import TrackModel

HERE = Path(__file__).parent
Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]
InputKind = Literal["twist", "track_cmd", "joint_cmd", "emg_stop", "angle", "angles", "drive_params"]
OutputKind = Literal["joint_state", "odometry", "pose", "global_pose", "imu", "fix", "heading"]


class FileError(Exception):
    """A machine or scene file cannot be used; the text says which and why."""


class Strict(BaseModel):
    """A part of a file; unknown keys are errors."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Unknowns(Strict):
    """What no source tells: options of the program."""

    yaw_gain: Positive = 0.6  # true yaw rate of tracks, as a part of what the wheels' speeds would give
    kick: NotNegative = 0.08  # rad that the base turns per rad/s that the swing gains
    droop: NotNegative = 1.0  # factor of what gravity pulls at joints
    lag: Positive = 1.0  # factor of all joints' lags
    dead_time: Annotated[float, Field(ge=-0.3)] = 0.0  # s added to all dead times


class JointFile(Strict):
    """A driven joint."""

    stiffness: Positive
    damping: Positive
    torque: Positive
    inertia: Positive
    gravity: float = 0.0
    limits: tuple[float, float] | None = None  # deg
    target: float = 0.0  # deg, at the start
    dead_time: Positive | None = None  # s, of front_cmd

    def drive(self, unknowns: Unknowns) -> DriveModel:
        """Constants of its drive."""
        low, high = (math.radians(one) for one in self.limits or (-math.inf, math.inf))
        return DriveModel(
            self.stiffness,
            self.damping * unknowns.lag,
            self.torque,
            self.inertia,
            self.gravity * unknowns.droop,
            low,
            high,
        )


class TracksFile(Strict):
    """Both tracks, see TrackModel."""

    half_tread: Positive
    radius: Positive
    p: Positive
    i: float
    d: float
    torque: Positive
    brake: Positive
    fastest: Positive = 3.0
    divisor: Positive

    def model(self, mass: float) -> TrackModel:
        """Constants of a machine of this mass [kg]."""
        return TrackModel(mass=mass, **self.model_dump())


class Input(Strict):
    """A topic that a machine hears."""

    kind: InputKind
    joint: str | None = None  # of angle and drive_params


class Output(Strict):
    """A topic that a machine tells."""

    kind: OutputKind
    period: Positive  # s, as the prefab has it; the real one is a number of steps
    frame: str
    child: str = ""
    joints: tuple[str, ...] = ()  # that turn an IMU: swing, then those that pitch it


class MachineFile(Strict):
    """A prefab. `{name}` in topics and frames is the name of the machine in its scene."""

    mass: Positive  # kg
    joints: dict[str, JointFile | None]  # in the order of their messages; None: nothing drives it
    tracks: TracksFile
    inputs: dict[str, Input]
    outputs: dict[str, Output]


class Placed(Strict):
    """A machine of a scene."""

    model: str
    place: tuple[float, float, float]  # m
    yaw: float = 0.0  # deg


class Scene(Strict):
    """Which machines are where."""

    machines: dict[Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")], Placed]


Loaded = TypeVar("Loaded", MachineFile, Scene)


def scenes() -> list[str]:
    """Names of the scenes that there are."""
    return sorted(path.stem for path in (HERE / "scenes").glob("*.yaml"))


def scene(name: str) -> Scene:
    """The scene of this name, or of this file."""
    return _load(Path(name) if name.endswith(".yaml") else HERE / "scenes" / f"{name}.yaml", Scene)


def machine(model: str) -> MachineFile:
    """The prefab of this name."""
    return _load(HERE / "machines" / f"{model}.yaml", MachineFile)


def _load(path: Path, kind: type[Loaded]) -> Loaded:
    try:
        return kind.model_validate(yaml.safe_load(path.read_text(encoding="utf-8")))
    except OSError as error:
        raise FileError(f"{path}: {error.strerror}") from error
    except yaml.YAMLError as error:
        raise FileError(f"{path}: {error}") from error
    except ValidationError as error:
        raise FileError(f"{path}: {_explained(error.errors())}") from error


def _explained(errors: Iterable[object]) -> str:
    return "; ".join(str(one) for one in errors)
