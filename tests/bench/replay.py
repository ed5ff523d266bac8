"""A rehearsal: ten minutes of odometry (50 a second) played into a sensing input at 20 times their speed.

The floor is the time that this takes by the stamps of the recording.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

import yaml
from builtin_interfaces.msg import Time
from nav_msgs.msg import Odometry
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from bench.rig.mesh import Rig, rig, until
from bench.runner import Figure
from tms_ros.packing import pack

HZ, MINUTES, SPEED = 50, 10, 20
TOLD = 5.0  # s
MESSAGES = HZ * MINUTES * 60
SECOND = 1_000_000_000  # ns
BEGAN = 1_700_000_000 * SECOND
INPUT = {"topic": "/odometry", "type": "nav_msgs/msg/Odometry", "model": "bench", "record": "track",
         "fields": {"x": "pose.pose.position.x"}}  # fmt: skip


def measure() -> Iterable[Figure]:
    with rig(services={"db": {}, "sp": {}, "host": {}}, machines={}, sensing="sensing.yaml") as own:
        folder = own.site.path.parent
        (folder / "sensing.yaml").write_text(yaml.safe_dump({"inputs": {"track": INPUT}}))
        bag = _recorded(folder / "bag")
        own.mesh.tms("up")
        own.mesh.tms("param", "set", "bench/track", "x=-1.0", "--create", "--type", "dynamic")
        words = ("sensing", "replay", str(bag), "--speed", str(SPEED), "--json")
        done = json.loads(own.mesh.tms(*words, limit=300).stdout)
        until(lambda: _x(own) == MESSAGES - 1.0, "the last position is stored", 30.0)
        with suppress(TimeoutError):  # what is still missing then is lost
            until(lambda: _counted(own)["all"] >= MESSAGES, "the counts are told, once a second", TOLD)
        state = _counted(own)
    planned = MESSAGES / HZ / SPEED
    yield Figure("ten minutes", "s", done["seconds"], 1.1 * planned, planned)
    yield Figure("refused", "", float(state["refused"]), 0.5)
    yield Figure("lost", "", float(MESSAGES - state["all"]), 0.5)


def _recorded(folder: Path) -> Path:
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as bag:
        track = bag.add_connection("/odometry", INPUT["type"], typestore=get_typestore(Stores.ROS2_JAZZY))
        message = Odometry()
        for number in range(MESSAGES):
            moment = BEGAN + number * SECOND // HZ
            message.header.stamp = Time(sec=moment // SECOND, nanosec=moment % SECOND)
            message.pose.pose.position.x = float(number)
            bag.write(track, moment, pack(message))
    return folder


def _counted(own: Rig) -> dict[str, int]:
    (state,) = json.loads(own.mesh.tms("sensing", "--json").stdout)
    return {"refused": state["refused"], "all": state["accepted"] + state["refused"]}


def _x(own: Rig) -> float:
    return float(json.loads(own.mesh.tms("param", "get", "bench/track", "--json").stdout)["values"]["x"])
