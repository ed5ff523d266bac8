"""The recording of a run as a file, made piece by piece while it is sent: a shift has hundreds of megabytes."""

import csv
import io
import math
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from datetime import datetime, timezone
from typing import Any

import numpy as np
from mcap.writer import Writer
from rosbags.typesys import Stores, get_typestore

from tms_control.links import Array, quaternion, turned
from tms_machine.frames import MAP
from tms_ur.body_models import JointOrigin, SiteMachine
from tms_ur.models import Event
from tms_ur.recording_client import Asked
from tms_ur.recording_models import Recording, Series

WINDOW = 300.0  # s that are in memory at a time
ALL = 20_000  # points: more than a window has
ALARMING = ("stop", "alarm", "error", "warning")  # kinds of events
INFO, WARN = 20, 30  # levels of rcl_interfaces/Log
STEP = 0.1  # s between rows of a table
UNITS = {"x": "m", "y": "m", "yaw": "rad", "mass": "kg", "bank": "m3", "loose": "m3"}


class Export:
    """The recording of one run, in windows."""

    def __init__(self, read: Callable[[Asked], Recording], run_id: str) -> None:
        """`read`: asks for a recording.

        Raises:
            TmsError: RUN_MISSING, or tms:db is away.
        """
        self._read, self.run_id = read, run_id
        self.ends = read(Asked(run_id, points=2)).series  # the first and the last row of each series

    def windows(self) -> Iterator[list[Series]]:
        """All series, window by window."""
        times = [time for one in self.ends for time in one.times]
        begin, end = (math.floor(min(times)), max(times)) if times else (0.0, -1.0)
        while begin <= end:
            part = Asked(begin=begin, end=begin + WINDOW - 0.001, points=ALL)
            yield self._read(part).series
            begin += WINDOW


def _moment(seconds: float) -> datetime:
    return datetime.fromtimestamp(seconds, timezone.utc)


def as_csv(export: Export) -> Iterator[bytes]:
    """A row for each tenth of a second, a column for each value of a machine; with a byte order mark for Excel."""
    columns = sorted({(one.machine, one.kind, name) for one in export.ends for name in one.names})
    out = io.StringIO()
    rows = csv.writer(out)
    rows.writerow(["time", *(f"{machine}/{name} [{UNITS.get(name, 'rad')}]" for machine, _, name in columns)])
    yield b"\xef\xbb\xbf"
    for window in export.windows():
        table: dict[int, dict[tuple[str, str, str], float]] = defaultdict(dict)
        for one in window:
            for name, values in zip(one.names, one.values, strict=True):
                for time, value in zip(one.times, values, strict=True):
                    table[round(time / STEP)][one.machine, one.kind, name] = value
        for at in sorted(table):
            stamp = _moment(at * STEP).isoformat(timespec="milliseconds")
            rows.writerow([stamp, *(table[at].get(column, "") for column in columns)])
        yield _taken(out)
    yield _taken(out)  # the heads, where there was no window


def _taken(out: io.StringIO) -> bytes:
    text = out.getvalue()
    out.seek(0)
    out.truncate()
    return text.encode()


class Sent:
    """The stream that the writer of MCAP writes to."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._at = 0

    def write(self, data: bytes) -> int:
        """Keep bytes until `take`."""
        self._parts.append(bytes(data))
        self._at += len(data)
        return len(data)

    def tell(self) -> int:
        """Bytes so far."""
        return self._at

    def take(self) -> bytes:
        """What was written since the call before."""
        parts, self._parts = self._parts, []
        return b"".join(parts)


class Bag:
    """An MCAP file as rosbag2 writes them. Messages are made by `rosbags`: those of rclpy end in arbitrary bytes."""

    def __init__(self) -> None:
        self.sent = Sent()
        self._writer = Writer(self.sent)  # which only writes and tells
        self._writer.start(profile="ros2", library="ros2-tms")
        self._types = get_typestore(Stores.ROS2_JAZZY)
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}

    def make(self, kind: str, *fields: Any) -> Any:
        """A message; `kind`: package/Name, the fields in their order."""
        return self._types.types[_full(kind)](*fields)

    def add(self, topic: str, kind: str, at: float, *fields: Any) -> None:
        """Add a message at a time [s since 1970]."""
        if topic not in self._channels:
            if kind not in self._schemas:
                text, _ = self._types.generate_msgdef(_full(kind), ros_version=2)
                self._schemas[kind] = self._writer.register_schema(_full(kind), "ros2msg", text.encode())
            self._channels[topic] = self._writer.register_channel(topic, "cdr", self._schemas[kind])
        data, stamp = self._types.serialize_cdr(self.make(kind, *fields), _full(kind)), round(at * 1e9)
        self._writer.add_message(self._channels[topic], stamp, bytes(data), stamp)

    def time(self, at: float) -> Any:
        """A time [s since 1970] as a message."""
        return self.make("builtin_interfaces/Time", int(at), int(at % 1 * 1e9))

    def header(self, at: float, frame: str) -> Any:
        """A header as a message."""
        return self.make("std_msgs/Header", self.time(at), frame)

    def finish(self) -> None:
        """Write the end of the file."""
        self._writer.finish()


def _full(kind: str) -> str:
    return kind.replace("/", "/msg/")


def as_mcap(export: Export, events: list[Event], bodies: Sequence[SiteMachine]) -> Iterator[bytes]:
    """Joint states, poses, /tf of all links, loads, and the journal of the run."""
    bag, joints = Bag(), {body.name: body.joints for body in bodies}
    for event in events:
        _add_event(bag, event)
    yield bag.sent.take()
    for window in export.windows():
        rows = [(time, one, row) for one in window for row, time in enumerate(one.times)]
        for time, one, row in sorted(rows, key=lambda found: found[0]):
            values = {name: column[row] for name, column in zip(one.names, one.values, strict=True)}
            _add(bag, one, time, values, joints.get(one.machine, []))
        yield bag.sent.take()
    bag.finish()
    yield bag.sent.take()


def _add_event(bag: Bag, event: Event) -> None:
    """An event as the tools of ROS list them: its kind as the name, node as function, number as line."""
    at = event.stamp.timestamp() if event.stamp else 0.0
    text = event.text if event.reason is None else event.reason.text.en
    level = WARN if event.kind in ALARMING else INFO
    bag.add("/tms/events", "rcl_interfaces/Log", at,
            bag.time(at), level, event.kind, text, "", event.node, event.number)  # fmt: skip


def _add(bag: Bag, of: Series, at: float, values: dict[str, float], joints: Sequence[JointOrigin]) -> None:
    machine, none = of.machine, np.empty(0)
    base = f"{machine}/base_link"
    if of.kind == "joints":
        angles = np.array(list(values.values()))
        bag.add(f"/{machine}/joint_states", "sensor_msgs/JointState", at,
                bag.header(at, base), list(values), angles, none, none)  # fmt: skip
        links = [_link(bag, at, machine, one, values.get(one.joint, 0.0)) for one in joints]
        bag.add("/tf", "tf2_msgs/TFMessage", at, links)
    elif of.kind == "pose":
        x, y, turn = values["x"], values["y"], turned("z", values["yaw"])
        pose = bag.make("geometry_msgs/Pose", bag.make("geometry_msgs/Point", x, y, 0.0), _quaternion(bag, turn))
        bag.add(f"/{machine}/pose", "geometry_msgs/PoseStamped", at, bag.header(at, MAP), pose)
        bag.add("/tf", "tf2_msgs/TFMessage", at, [_transform(bag, at, MAP, base, (x, y, 0.0), turn)])
    else:
        for name, value in values.items():
            bag.add(f"/{machine}/load/{name}", "std_msgs/Float64", at, value)


def _link(bag: Bag, at: float, machine: str, joint: JointOrigin, angle: float) -> Any:
    turn = turned("y", joint.pitch) @ turned(joint.axis, angle)
    return _transform(bag, at, f"{machine}/{joint.parent}", f"{machine}/{joint.child}", joint.xyz, turn)


def _transform(bag: Bag, at: float, parent: str, child: str, place: Sequence[float], turn: Array) -> Any:
    moved = bag.make("geometry_msgs/Transform", bag.make("geometry_msgs/Vector3", *place), _quaternion(bag, turn))
    return bag.make("geometry_msgs/TransformStamped", bag.header(at, parent), child, moved)


def _quaternion(bag: Bag, axes: Array) -> Any:
    return bag.make("geometry_msgs/Quaternion", *quaternion(axes))
