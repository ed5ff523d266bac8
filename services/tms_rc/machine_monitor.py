"""Turns the ROS messages of every source of the machine into samples, and finds other publishers of these topics."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from geometry_msgs.msg import Pose, PoseStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, JointState

from tms_config.clock import monotonic
from tms_config.models import Border
from tms_decision.gateway.events import Event, Published, Sampled
from tms_machine import stamps
from tms_machine.geometry import yaw_of
from tms_machine.places import POSES, pose_of
from tms_proof.channel import Place
from tms_proof.source import LABELS, SourceSample
from tms_proof.standstill import HEADING, IMU, JOINTS, ODOM, PLACE, TURNING, StandStill
from tms_rc.reasons import StrangeType
from tms_reason.reason import Reason
from tms_ros.node import Ros
from tms_ros.topics import Arrival
from tms_runtime.app import App
from tms_runtime.graph import node_of

DEPTH = 10  # messages of a source that may come between two beats
VOICES = 0.25  # s between checks of who publishes

Numbers = tuple[Mapping[str, Place], Mapping[str, float]]  # places and speeds by channel


class MachineMonitor:
    """Takes the messages that have come since the last beat, at every beat of the pulse: no callback delays it."""

    def __init__(self, app: App, watch: StandStill) -> None:
        self._app, self._watch = app, watch
        border = app.site.border(app.machine)
        self._names = {border.joints.get(name, name): name for name in app.site.model_of(app.machine).joints}
        self._topics: dict[str, str] = {name: f"/{app.machine}/{getattr(border, name)}" for name in border.sources}
        self._inputs = [
            (name, app.ros.sample_arrivals(_type(name, border), topic, DEPTH), self._reader(name))
            for name, topic in self._topics.items()
        ]
        by_topic = {reader.topic_name: reader for reader in app.ros.node.subscriptions}
        self._readers = {name: by_topic[topic] for name, topic in self._topics.items()}
        self._counted = 0.0  # monotonic

    def samples(self) -> list[Event]:
        """The waiting messages, and changes of who publishes them."""
        now, found = monotonic(), list[Event]()
        for name, take_new, read in self._inputs:
            source, arrivals = self._watch.sources[name], take_new()
            if arrivals and source.age(now) > source.longest:
                found += self._count(name)  # before its messages count: the topic may have several publishers now
            found += [Sampled(name, _sample(arrival, *read(arrival.message))) for arrival in arrivals]
        if now - self._counted >= VOICES:
            self._counted = now
            for name in self._topics:
                found += self._count(name)
        return found

    def _count(self, name: str) -> list[Event]:
        """Find other publishers of a source. The machine's own one, if killed, counts until discovery drops it."""
        known, topic = self._watch.sources[name].publishers, self._topics[name]
        count = int(self._readers[name].get_publisher_count())  # of those it hears, without a walk through the graph
        if len(known) == count or (count < 2 and not known):
            return []
        nodes = () if count < 2 else tuple(node for node, _ in _publishers(self._app.ros, topic))
        return [Published(name, nodes)]

    def strange_type(self) -> Reason | None:
        """A source that is published with another type than in the border: none of its messages can be received."""
        for name, topic in self._topics.items():
            source = self._watch.sources[name]
            if source.age(monotonic()) <= source.longest:
                continue
            wanted = _full_name(_type(name, self._app.site.border(self._app.machine)))
            for node, kind in _publishers(self._app.ros, topic):
                if kind != wanted:
                    return StrangeType(LABELS[name], node, topic, kind, wanted)
        return None

    def _reader(self, name: str) -> Callable[[Any], Numbers]:
        if name == JOINTS:
            return self._joints
        if name == IMU:
            return _imu
        return _odometry if name == ODOM else _pose

    def _joints(self, message: JointState) -> Numbers:
        """Joint states are matched by name: backends order them differently, and may send some joints at a time."""
        known = [(i, self._names[name]) for i, name in enumerate(message.name) if name in self._names]
        places = {name: (value,) for name, value in _numbers(known, message.position).items()}
        return places, _numbers(known, message.velocity)


def _publishers(ros: Ros, topic: str) -> list[tuple[str, str]]:
    """Node and type of each publisher of a topic in the whole graph."""
    return [(node_of(end), end.topic_type) for end in ros.node.get_publishers_info_by_topic(topic)]


def _type(name: str, border: Border) -> Any:
    if name == JOINTS:
        return JointState
    if name == IMU:
        return Imu
    return Odometry if name == ODOM else POSES[border.sources["pose"].message]


def _full_name(kind: Any) -> str:
    return f"{kind.__module__.split('.')[0]}/msg/{kind.__name__}"


def _sample(arrival: Arrival[Any], places: Mapping[str, Place], speeds: Mapping[str, float]) -> SourceSample:
    stamp = stamps.seconds(arrival.message.header.stamp)
    return SourceSample(arrival.received, stamp, arrival.number, places, speeds)


def _numbers(known: list[tuple[int, str]], values: Sequence[float]) -> dict[str, float]:
    """Numbers by joint, without those that are missing or not finite."""
    return {name: values[i] for i, name in known if i < len(values) and math.isfinite(values[i])}


def _placed(pose: Pose) -> dict[str, Place]:
    at, turn = pose.position, pose.orientation
    numbers = (at.x, at.y, turn.x, turn.y, turn.z, turn.w)
    if not all(map(math.isfinite, numbers)):
        return {}
    return {PLACE: (at.x, at.y), HEADING: (yaw_of((turn.x, turn.y, turn.z, turn.w)),)}


def _pose(message: PoseStamped | Odometry) -> Numbers:
    """A pose, also as odometry: its twist is not filled in, which does not mean a speed of 0."""
    return _placed(pose_of(message)), {}


def _odometry(message: Odometry) -> Numbers:
    speed = message.twist.twist
    speeds = {PLACE: math.hypot(speed.linear.x, speed.linear.y), HEADING: speed.angular.z}
    return _placed(message.pose.pose), {name: value for name, value in speeds.items() if math.isfinite(value)}


def _imu(message: Imu) -> Numbers:
    turning = message.angular_velocity
    speed = math.hypot(turning.x, turning.y, turning.z)
    return ({TURNING: ()}, {TURNING: speed}) if math.isfinite(speed) else ({}, {})
