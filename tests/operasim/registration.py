"""Which topics the simulator registers, and in which order. Pure."""

import random
from collections.abc import Iterable
from dataclasses import dataclass

from operasim.framing import command
from operasim.model import Input, MachineFile, Output

QUEUE = 10
LATE = 0.1  # s after the start: the topics of single joints
INPUT_TYPES = {
    "twist": "geometry_msgs/Twist", "track_cmd": "com3_msgs/JointCmd", "joint_cmd": "com3_msgs/JointCmd",
    "emg_stop": "std_msgs/Bool", "angle": "std_msgs/Float64", "angles": "sensor_msgs/JointState",
    "drive_params": "std_msgs/Float64MultiArray",
}  # fmt: skip
OUTPUT_TYPES = {
    "joint_state": "sensor_msgs/JointState", "odometry": "nav_msgs/Odometry", "pose": "geometry_msgs/PoseStamped",
    "global_pose": "nav_msgs/Odometry", "imu": "sensor_msgs/Imu", "fix": "sensor_msgs/NavSatFix",
    "heading": "geometry_msgs/QuaternionStamped",
}  # fmt: skip
# When the scripts start that register these: the drivers of tracks have a later turn than all others.
ANGLES, TRACKS, JOINTS = 1, 2, 3
TURNS = {"angles": ANGLES, "twist": TRACKS, "track_cmd": TRACKS, "odometry": TRACKS, "angle": JOINTS}


@dataclass(frozen=True)
class Registration:
    """A topic that is published or subscribed."""

    topic: str
    type: str
    publish: bool

    @property
    def command(self) -> bytes:
        """It as a frame."""
        if self.publish:
            return command("__publish", topic=self.topic, message_name=self.type, queue_size=QUEUE, latch=False)
        return command("__subscribe", topic=self.topic, message_name=self.type)


@dataclass(frozen=True)
class Registrations:
    """Those of the first frame, and those that come LATE."""

    first: list[Registration]
    late: list[Registration]


def registrations(machines: dict[str, MachineFile], chance: random.Random) -> Registrations:
    """All of a scene. Scripts of one turn start in any order; a topic is registered once, whoever wants it."""
    turns: list[list[Registration]] = [[Registration("clock", "rosgraph_msgs/Clock", True)], [], [], []]
    for name, file in machines.items():
        for topic, one in (file.inputs | file.outputs).items():
            turns[TURNS.get(one.kind, 0)].append(_registration(topic.format(name=name), one))
    chance.shuffle(turns[0])
    transforms = Registration("/tf", "tf2_msgs/TFMessage", False)  # it hears them, and never sends any
    return Registrations(_once([transforms, *turns[0], *turns[ANGLES], *turns[TRACKS]]), _once(turns[JOINTS]))


def on_connect(found: Iterable[Registration], first: bool) -> list[bytes]:
    """What is sent after the connection is made. At the first time, topics that it publishes come twice."""
    frames = []
    for one in found:
        frames += [one.command] * (2 if first and one.publish else 1)
    return [*frames, command("__topic_list")]


def _registration(topic: str, one: Input | Output) -> Registration:
    if isinstance(one, Input):
        return Registration(topic, INPUT_TYPES[one.kind], False)
    return Registration(topic, OUTPUT_TYPES[one.kind], True)


def _once(found: list[Registration]) -> list[Registration]:
    return list(dict.fromkeys(found))
