"""tms:sp and tms:db with a real store: what sensing PCs publish, what is refused, and a database that goes away."""

import json
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from geometry_msgs.msg import PointStamped
from nav_msgs.msg import Odometry
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore
from sensing_msgs.msg import ExcavateSimple, Flgs, FollowWaypoints
from std_msgs.msg import Float64
from tms_msg_db.msg import RecordChanges
from tms_msg_db.srv import GetParameter, ListParameterHistory, SetParameter
from tms_msg_sp.msg import InputStates

import programs
from conftest import PROJECT
from few_processes import Mesh, bare
from tms_db.reasons import TooOld
from tms_if.on_executor import do
from tms_machine.values import from_parameters, to_parameters
from tms_reason import wire
from tms_reason.errors import RosError
from tms_ros.packing import pack
from words import words

pytestmark = [
    pytest.mark.turns,
    pytest.mark.ros,
    pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning"),  # a parser that the ROS wheels bring
]
POINTS = """
  point:
    topic: /point
    type: geometry_msgs/msg/PointStamped
    model: zx200
    record: point
    fields: {x: point.x, y: point.y}
    range: {x: [-100, 100]}
  track:
    topic: /track
    type: nav_msgs/msg/Odometry
    depth: 1000
    model: zx200
    record: track
    fields: {x: pose.pose.position.x}
"""
START = {
    "zx200/target": {"x": 0.0, "Y": 0.0, "z": 7.0, "theta_w": 0.0, "other": 5},
    "zx200/path": {"x": [0.0], "y": [0.0], "z": [0.0]},
    "zx200/point": {"x": 0.0, "y": 0.0},
    "zx200/track": {"x": -1.0},
    "/FLAGS": {"LOADED_FLG": False, "CONTINUE_FLG": False, "N": 1},
}


class Sensing(Mesh):
    """With tms:sp, some records, and what tells of the inputs."""

    def prepare(self) -> None:
        text = (PROJECT / "configs" / "sensing.yaml").read_text() + POINTS
        self.site.path.with_name("sensing.yaml").write_text(text)
        for name in ("tms:store", "tms:db", "tms:sp"):
            self.start(name)
        self.wait_ready()
        self.inputs: dict[str, Any] = {}
        self.changed: list[str] = []
        self.ros.subscribe(InputStates, "/tms/sp/inputs", self._received, latched=True)
        self.ros.subscribe(RecordChanges, "/tms/db/changes", lambda m: self.changed.extend(m.record_names), depth=100)
        for key, fields in START.items():
            self.set(key, fields, type="dynamic", create=True)
        self.until(lambda: bool(self.inputs), "the state of the inputs")

    def _received(self, message: Any) -> None:
        self.inputs = {one.name: one for one in message.inputs}

    def set(self, key: str, fields: dict[str, Any], **more: Any) -> Any:
        model, record = key.split("/")
        values = to_parameters(fields)
        return self.db(SetParameter, "set_parameter", model_name=model, record_name=record, values=values, **more)

    def get(self, key: str, max_age: float = -1.0) -> Any:
        model, record = key.split("/")
        return self.db(GetParameter, "get_parameter", model_name=model, record_name=record, max_age=max_age)

    def values(self, key: str) -> dict[str, Any]:
        return from_parameters(self.get(key).record.values)

    def publisher(self, kind: Any, topic: str) -> Callable[[Any], None]:
        publisher = self.ros.publisher(kind, topic, depth=100)
        # An input that shares its topic with others listens only once somebody publishes.
        self.until(lambda: publisher.get_subscription_count() > 0, f"a reader of {topic}")
        return publisher.publish

    def refused(self, name: str, code: str) -> None:
        try:
            self.until(lambda: self.inputs[name].last_refusal.startswith(code), f"{code} of {name}")
        except pytest.fail.Exception as error:
            raise AssertionError(f"it said {self.inputs[name].last_refusal}") from error


@pytest.fixture
def sensing(tmp_path: Path, own_domain: int) -> Iterator[Sensing]:
    for mesh in bare(tmp_path, own_domain, Sensing):
        mesh.prepare()
        yield mesh


def test_messages_change_records_and_bad_ones_do_not(sensing: Sensing, tmp_path: Path) -> None:
    fields_by_name_whatever_their_case(sensing)
    bad_messages_are_told_and_the_last_good_value_stays(sensing)
    a_record_that_is_locked_stays(sensing)
    stamps(sensing)
    flags_and_those_that_stay(sensing)
    the_history_of_a_record(sensing)
    stale_records_are_refused(sensing)
    a_recording_is_played(sensing, tmp_path)
    what_waits_is_heard_in_one_go(sensing)


def fields_by_name_whatever_their_case(sensing: Sensing) -> None:
    publish = sensing.publisher(ExcavateSimple, "/tms_sp_excavate_simple")
    publish(ExcavateSimple(model_name="zx200", record_name="target", x=1.0, y=2.0, z=3.0, theta_w=0.5))
    wanted = {"x": 1.0, "Y": 2.0, "z": 3.0, "theta_w": 0.5, "other": 5}
    sensing.until(lambda: sensing.values("zx200/target") == wanted, "the new values")
    assert sensing.get("zx200/target").record.source == "sp excavate_simple"
    publish_path = sensing.publisher(FollowWaypoints, "/tms_sp_follow_waypoints")
    three = {axis: [1.0, 2.0, 3.0] for axis in ("x", "y", "z", "qx", "qy", "qz", "qw")}
    publish_path(FollowWaypoints(model_name="zx200", record_name="path", **three))
    sensing.until(lambda: sensing.values("zx200/path")["z"] == [1.0, 2.0, 3.0], "the new path")


def bad_messages_are_told_and_the_last_good_value_stays(sensing: Sensing) -> None:
    dig = sensing.publisher(ExcavateSimple, "/tms_sp_excavate_simple")
    path = sensing.publisher(FollowWaypoints, "/tms_sp_follow_waypoints")
    before = sensing.values("zx200/target"), sensing.values("zx200/path")
    sensing.set("zx200/fixed", {"x": 1.0}, type="static", create=True)
    for record, x, code in (
        ("target", float("nan"), "VALUE_NOT_FINITE"),
        ("nowhere", 1.0, "RECORD_MISSING"),
        ("fixed", 1.0, "STATIC_FROM_SENSING"),
        ("", 1.0, "NAMES_NO_RECORD"),
    ):
        dig(ExcavateSimple(model_name="zx200", record_name=record, x=x))
        sensing.refused("excavate_simple", code)
    path(FollowWaypoints(model_name="zx200", record_name="path", x=[1.0, 2.0], y=[1.0], z=[1.0]))
    sensing.refused("follow_waypoints", "SIZES_DIFFER")
    one = {axis: [1.0] for axis in ("x", "y", "z", "qx", "qy", "qz", "qw")}
    path(FollowWaypoints(model_name="zx200", record_name="target", **one))
    sensing.refused("follow_waypoints", "OTHER_KIND")
    assert (sensing.values("zx200/target"), sensing.values("zx200/path")) == before


def a_record_that_is_locked_stays(sensing: Sensing) -> None:
    dig = sensing.publisher(ExcavateSimple, "/tms_sp_excavate_simple")
    before = sensing.get("zx200/target").record
    sensing.set("zx200/target", {"LOCK_FLG": True, "LOCK_OWNER": "plan", "LOCK_UNTIL": time.time() + 300})
    after = sensing.get("zx200/target").record
    assert (after.updated_at, after.source) == (before.updated_at, before.source)
    dig(ExcavateSimple(model_name="zx200", record_name="target", x=7.0))
    sensing.refused("excavate_simple", "LOCKED_RECORD")
    assert sensing.values("zx200/target")["x"] == 1.0
    sensing.set("zx200/target", {"LOCK_UNTIL": time.time() - 1})  # nobody has come to free it
    dig(ExcavateSimple(model_name="zx200", record_name="target", x=6.0))
    sensing.until(lambda: sensing.values("zx200/target")["x"] == 6.0, "the value after the lease")
    sensing.set("zx200/target", {"LOCK_FLG": False}, remove=["LOCK_OWNER", "LOCK_UNTIL"])
    dig(ExcavateSimple(model_name="zx200", record_name="target", x=7.0))
    sensing.until(lambda: sensing.values("zx200/target")["x"] == 7.0, "the value after the lock")


def stamps(sensing: Sensing) -> None:
    publish = sensing.publisher(PointStamped, "/point")

    def point(x: float, ahead: float) -> None:
        message = PointStamped()
        now = time.time() + ahead
        message.header.stamp = Time(sec=int(now), nanosec=int(now % 1 * 1e9))
        message.point.x = x
        publish(message)

    point(1.0, 0.0)
    sensing.until(lambda: sensing.values("zx200/point")["x"] == 1.0, "the point")
    for x, ahead, code in (
        (2.0, 60.0, "STAMP_IN_FUTURE"),
        (3.0, -60.0, "MEASURED_EARLIER"),
        (101.0, 0.0, "VALUE_OUT_OF_RANGE"),
    ):
        point(x, ahead)
        sensing.refused("point", code)
    assert sensing.values("zx200/point")["x"] == 1.0
    state = sensing.inputs["point"]
    assert (state.accepted, state.refused, state.state, state.records) == (1, 3, "alive", ["zx200/point"])


def flags_and_those_that_stay(sensing: Sensing) -> None:
    sensing.changed.clear()
    publish = sensing.publisher(Flgs, "/Flgs")
    publish(Flgs(record_name="FLAGS", loaded_flg=True))
    sensing.until(lambda: sensing.values("/FLAGS")["LOADED_FLG"], "the flag")
    sensing.until(lambda: "FLAGS" in sensing.changed, "readers are told")
    publish(Flgs(record_name="FLAGS", loaded_flg=False, keep_val_flgs=["LOADED_FLG"]))
    sensing.until(lambda: sensing.inputs["flags"].written == 2, "the second message")
    assert sensing.values("/FLAGS") == {"LOADED_FLG": True, "CONTINUE_FLG": False, "N": 1}


def the_history_of_a_record(sensing: Sensing) -> None:
    sensing.set("zx200/target", {"x": 4.0}, source="cli somebody")
    answer = sensing.db(ListParameterHistory, "list_parameter_history", model_name="zx200", record_name="target")
    newest, *older = answer.changes
    assert (newest.source, from_parameters(newest.values)) == ("cli somebody", {"x": 4.0})
    assert "sp excavate_simple" in [one.source for one in older]
    missing = sensing.db(ListParameterHistory, "list_parameter_history", model_name="zx200", record_name="none")
    assert missing.error_code == "RECORD_MISSING"


def stale_records_are_refused(sensing: Sensing) -> None:
    assert sensing.get("zx200/target", 60.0).error_code == ""
    time.sleep(0.02)
    answer = sensing.get("zx200/target", 0.01)
    assert answer.error_code == "STALE_RECORD"
    assert wire.known(answer.error_msg).find(TooOld)
    assert "allowed are 0.0 s (last from cli somebody)" in words(answer.error_msg)
    sensing.set("zx200/target", {}, max_age=0.01)
    time.sleep(0.02)
    assert sensing.get("zx200/target", 0.0).error_code == "STALE_RECORD"
    assert sensing.get("zx200/target").error_code == ""


def a_recording_is_played(sensing: Sensing, folder: Path) -> None:
    """Ten seconds of odometry, two years old, at 20 times its speed."""
    store = get_typestore(Stores.ROS2_JAZZY)
    with Writer(folder / "bag", version=9, storage_plugin=StoragePlugin.MCAP) as bag:
        track = bag.add_connection("/track", "nav_msgs/msg/Odometry", typestore=store)
        for number in range(500):
            message = Odometry()
            message.header.stamp = Time(sec=1_700_000_000 + number // 50, nanosec=number % 50 * 20_000_000)
            message.pose.pose.position.x = float(number)
            bag.write(track, 1_700_000_000_000_000_000 + number * 20_000_000, pack(message))
    words = ("--site", str(sensing.site.path), "sensing", "replay", str(folder / "bag"), "--speed", "20", "--json")
    done = programs.tms(words, sensing.environment, 60)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["sent"] == {"/track": 500}
    sensing.until(lambda: sensing.values("zx200/track")["x"] == 499.0, "the last position")
    sensing.until(lambda: sensing.inputs["track"].accepted == 500, "all positions")
    assert (sensing.inputs["track"].refused, sensing.inputs["track"].last_refusal) == (0, "")
    assert sensing.inputs["track"].clock_offset == pytest.approx(0.0, abs=0.5)


def what_waits_is_heard_in_one_go(sensing: Sensing) -> None:
    ros, received = sensing.ros, list[float]()
    subscription = ros.subscribe(Float64, "/waiting", lambda message: receive(message.data), depth=100)
    publisher = ros.publisher(Float64, "/waiting", depth=100)
    sensing.until(lambda: publisher.get_subscription_count() > 0, "a reader of /waiting")

    def receive(value: float) -> None:
        received.append(value)
        if value == 0.0:
            ros.start(another_turn)
        if value == 49.0:  # in the midst of what waits
            ros.node.destroy_subscription(subscription)

    async def another_turn() -> None:
        received.append(-1.0)

    def send() -> None:  # the executor hears nothing meanwhile
        for number in range(60):
            publisher.publish(Float64(data=float(number)))
        assert ros.delivered(publisher, 5.0)

    do(ros, send, 10.0)
    sensing.until(lambda: -1.0 in received, "what waited")
    assert received == [*map(float, range(50)), -1.0]


def test_the_newest_value_is_written_when_the_store_returns(sensing: Sensing) -> None:
    publish = sensing.publisher(ExcavateSimple, "/tms_sp_excavate_simple")
    publish(ExcavateSimple(model_name="zx200", record_name="target", x=1.0))
    sensing.until(lambda: sensing.values("zx200/target")["x"] == 1.0, "the first value")
    sensing.kill("tms:store")
    sensing.wait_away()
    for x in range(2, 100):
        publish(ExcavateSimple(model_name="zx200", record_name="target", x=float(x)))
        time.sleep(0.005)  # the queue of an input is bounded
    sensing.until(lambda: sensing.inputs["excavate_simple"].accepted > 1, "the messages")
    assert sensing.inputs["excavate_simple"].written <= 1
    sensing.start("tms:store")
    sensing.wait_ready()
    sensing.until(lambda: sensing.values("zx200/target")["x"] == 99.0, "the newest value")


def write_all(
    writer: int, sensing: Sensing, left: Iterator[int], lock: threading.Lock, acknowledged: dict[str, int], until: float
) -> None:
    """Writes until none is left; every write is repeated until it is acknowledged."""
    number = 0
    while time.monotonic() < until:
        with lock:
            if next(left, None) is None:
                return
        number += 1
        key = f"w/{writer}_{number % 5}"
        request = SetParameter.Request(model_name="w", record_name=key[2:], values=to_parameters({"n": number}))
        while time.monotonic() < until:
            try:
                answer = sensing.ros.call(SetParameter, "/tms/db/set_parameter", request, 2.0)
            except RosError:
                continue
            if not answer.error_code:
                acknowledged[key] = number
                break
            time.sleep(0.05)


@pytest.mark.timeout(620)
def test_acknowledged_writes_outlive_the_death_of_store_and_database(sensing: Sensing) -> None:
    """10 000 writes over 20 records from 4 writers, while store and database are killed again and again."""
    acknowledged: dict[str, int] = {}
    left = iter(range(10_000))
    deadline = time.monotonic() + 500
    for writer in range(4):
        for one in range(5):
            sensing.set(f"w/{writer}_{one}", {"n": 0}, type="dynamic", create=True)
    lock = threading.Lock()
    write = (sensing, left, lock, acknowledged, deadline)
    writers = [threading.Thread(target=write_all, args=(number, *write)) for number in range(4)]
    for thread in writers:
        thread.start()
    for victim in ("tms:db", "tms:store", "tms:db"):
        seen = dict(acknowledged)
        sensing.until(lambda: sum(acknowledged.values()) > sum(seen.values()) + 100, "some writes")  # noqa: B023
        sensing.kill(victim)
        sensing.start(victim)
    for thread in writers:
        thread.join()
    sensing.kill("tms:store")
    sensing.kill("tms:db")
    sensing.start("tms:store")
    sensing.start("tms:db")
    sensing.wait_ready()
    stored = {key: sensing.values(key)["n"] for key in acknowledged}
    lost = {key: (number, stored[key]) for key, number in acknowledged.items() if stored[key] < number}
    assert not lost, json.dumps(lost)
    assert sum(acknowledged.values()) > 0
    assert next(left, None) is None, "not all writes were acknowledged in time"
