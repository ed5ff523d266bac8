"""The messages that the simulator sends and hears, from and to plain values. Pure; times are the simulator's."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from operasim.cdr import Reader, Writer

Layout = Literal["plain", "control_type"]
Quaternion = tuple[float, float, float, float]
Position = tuple[float, float, float]
Diagonal = tuple[float, ...]


@dataclass(frozen=True)
class Place:
    """Where something is: m, and x, y, z, w."""

    position: Position
    rotation: Quaternion


def clock(time: float) -> bytes:
    """rosgraph_msgs/Clock."""
    return Writer().stamp(time).message


def joint_state(time: float, frame: str, joints: Sequence[tuple[str, float, float]]) -> bytes:
    """sensor_msgs/JointState of names, positions and velocities; the efforts are zeros."""
    out = _header(time, frame).strings([name for name, _, _ in joints])
    out.doubles([position for _, position, _ in joints]).doubles([velocity for _, _, velocity in joints])
    return out.doubles([0.0] * len(joints)).message


def pose(time: float, frame: str, place: Place) -> bytes:
    """geometry_msgs/PoseStamped."""
    return _header(time, frame).put("d", *place.position, *place.rotation).message


def odometry(
    time: float, frames: tuple[str, str], place: Place, speeds: tuple[float, float], diagonal: Diagonal
) -> bytes:
    """nav_msgs/Odometry; both covariances have this diagonal."""
    covariance = _covariance(diagonal)
    out = _header(time, frames[0]).string(frames[1]).put("d", *place.position, *place.rotation, *covariance)
    return out.put("d", speeds[0], 0.0, 0.0, 0.0, 0.0, speeds[1], *covariance).message


def global_pose(time: float, frame: str, place: Place, diagonal: Diagonal) -> bytes:
    """nav_msgs/Odometry without child frame and twist."""
    out = _header(time, frame).string("").put("d", *place.position, *place.rotation, *_covariance(diagonal))
    return out.put("d", *[0.0] * 42).message


def imu(time: float, frame: str, rotation: Quaternion, turning: Position, pushed: Position) -> bytes:
    """sensor_msgs/Imu with rad/s and m/s2; its covariances are zeros."""
    out = _header(time, frame).put("d", *rotation, *[0.0] * 9).put("d", *turning, *[0.0] * 9)
    return out.put("d", *pushed, *[0.0] * 9).message


def fix(time: float, frame: str, latitude: float, longitude: float, altitude: float) -> bytes:
    """sensor_msgs/NavSatFix: deg, m, status 1, service GPS."""
    out = _header(time, frame).put("b", 1).put("H", 1).put("d", latitude, longitude, altitude, *[0.0] * 9)
    return out.put("B", 0).message


def heading(time: float, frame: str, rotation: Quaternion) -> bytes:
    """geometry_msgs/QuaternionStamped."""
    return _header(time, frame).put("d", *rotation).message


def read_twist(message: bytes) -> tuple[float, float]:
    """linear.x and angular.z of geometry_msgs/Twist: the simulator looks at no more."""
    values = Reader(message).take("d", 6)
    return values[0], values[5]


def read_bool(message: bytes) -> bool:
    """std_msgs/Bool."""
    return Reader(message).take("B")[0] != 0


def read_double(message: bytes) -> float:
    """std_msgs/Float64."""
    return Reader(message).take("d")[0]


def read_doubles(message: bytes) -> list[float]:
    """`data` of std_msgs/Float64MultiArray."""
    reader = Reader(message)
    for _ in range(int(reader.take("I")[0])):
        reader.string()
        reader.take("I", 2)
    reader.take("I")
    return reader.doubles()


def read_joint_state(message: bytes) -> tuple[list[str], list[float]]:
    """Names and positions of sensor_msgs/JointState."""
    reader = Reader(message)
    reader.take("I", 2)
    reader.string()
    return reader.strings(), reader.doubles()


def read_joint_cmd(message: bytes, layout: Layout) -> tuple[list[str], list[float], list[float]]:
    """Names, positions and velocities of com3_msgs/JointCmd. The simulator was built with the layout `plain`."""
    reader = Reader(message)
    names = reader.strings()
    if layout == "control_type":
        reader.take("B")
    return names, reader.doubles(), reader.doubles()


def _header(time: float, frame: str) -> Writer:
    return Writer().stamp(time).string(frame)


def _covariance(diagonal: Diagonal) -> list[float]:
    return [diagonal[i // 7] if i % 7 == 0 else 0.0 for i in range(36)]
