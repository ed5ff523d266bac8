"""`tms sensing replay`: recordings of both kinds, what is left out and why, stamps, and files that are none."""

import json
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
import yaml
from click.testing import Result
from nav_msgs.msg import Odometry
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from sensing_msgs.msg import ExcavateSimple, Flgs
from std_msgs.msg import Float64

from conftest import site_data
from tms_cli import session
from tms_cli.commands.sensing import command
from tms_cli.replay import matching, player
from tms_cli.replay.matching import built_hash
from tms_cli.replay.recording import Recording
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_reason.errors import TmsError
from tms_ros.packing import pack, unpack

SECOND = 1_000_000_000
BEGAN = 1_000 * SECOND  # of the recordings
INPUTS = {
    "track": {"topic": "odometry", "type": "nav_msgs/msg/Odometry", "model": "m", "record": "r",
              "fields": {"x": "pose.pose.position.x"}},
    "dig": {"topic": "/dig", "type": "sensing_msgs/msg/ExcavateSimple"},
    "machine": {"topic": "/zx200/joint_states", "type": "sensor_msgs/msg/JointState"},
    "flags": {"topic": "/Flgs", "type": "sensing_msgs/msg/Flgs", "model": ""},
}  # fmt: skip
BOTH = pytest.mark.parametrize("storage", [StoragePlugin.SQLITE3, StoragePlugin.MCAP], ids=["sqlite", "mcap"])
SAMPLE = "string record_name\nfloat64 x\n"


def odometry(number: int) -> tuple[str, str, int, bytes]:
    message = Odometry()
    message.header.stamp.sec, message.header.stamp.nanosec = 500 + number // 10, number % 10 * 100_000_000
    message.pose.pose.position.x = float(number)
    return "/odometry", "nav_msgs/msg/Odometry", BEGAN + number * SECOND // 10, pack(message)


def row(topic: str, kind: str, message: Any, at: float = 0.0) -> tuple[str, str, int, bytes]:
    return topic, kind, BEGAN + round(at * SECOND), pack(message) if not isinstance(message, bytes) else message


def record(
    folder: Path, rows: list[tuple[str, str, int, bytes]], storage: StoragePlugin, definitions: Any = ()
) -> Path:
    """A bag as `ros2 bag record` makes it; `definitions` replaces those of types."""
    store = get_typestore(Stores.ROS2_JAZZY)
    for name, text in dict(definitions).items():
        store.register(get_types_from_msg(text, name))
    connections: dict[tuple[str, str], Any] = {}
    with Writer(folder, version=9, storage_plugin=storage) as bag:
        for topic, kind, moment, data in rows:
            if (topic, kind) not in connections:
                there = {"typestore": store} if kind in store.types else {"msgdef": "", "rihs01": hash_of(kind)}
                connections[topic, kind] = bag.add_connection(topic, kind, **there)
            bag.write(connections[topic, kind], moment, data)
    return folder


def hash_of(kind: str) -> str:
    return built_hash(kind) if kind.startswith("sensing_msgs/") else "RIHS01_of_others"


class Publisher:
    def __init__(self, kind: Any) -> None:
        self.kind, self.sent = kind, list[bytes]()

    def get_subscription_count(self) -> int:
        return 1

    def publish(self, data: bytes) -> None:
        self.sent.append(data)

    @property
    def messages(self) -> list[Any]:
        return [unpack(data, self.kind) for data in self.sent]


class FakeRos:
    """Stands for a node whose topics are all heard."""

    def __init__(self) -> None:
        self.node = self
        self.others = 1  # publishers of a topic
        self.publishers: dict[str, Publisher] = {}

    def publisher(self, kind: Any, topic: str, depth: int) -> Publisher:
        return self.publishers.setdefault(topic, Publisher(kind))

    def count_publishers(self, topic: str) -> int:
        return self.others

    def delivered(self, publisher: Publisher, seconds: float) -> bool:
        return True


@pytest.fixture
def ros(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> FakeRos:
    fake = FakeRos()

    @contextmanager
    def node() -> Iterator[FakeRos]:
        yield fake

    (tmp_path / "site.yaml").write_text(yaml.safe_dump(site_data(43, 24300, sensing="sensing.yaml")))
    (tmp_path / "sensing.yaml").write_text(yaml.safe_dump({"inputs": INPUTS}))
    monkeypatch.setattr(session, "ros", node)
    monkeypatch.setattr(player, "LOOP_GAP", 0.0)
    return fake


@pytest.fixture
def replay(ros: FakeRos, tms: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    def run(*words: object) -> Result:
        monkeypatch.setenv("TMS_SITE", str(tmp_path / "site.yaml"))
        return tms(command, "replay", *words)

    return run


@BOTH
def test_every_message_is_played_byte_for_byte(
    replay: Callable[..., Result], ros: FakeRos, tmp_path: Path, storage: StoragePlugin
) -> None:
    rows = [odometry(number) for number in range(30)]
    rows += [row("/dig", "sensing_msgs/msg/ExcavateSimple", ExcavateSimple(record_name="a", x=2.5), at=1.0)]
    bag = record(tmp_path / "bag", sorted(rows, key=lambda each: each[2]), storage)
    done = replay(bag, "--speed", "1000", "--keep-stamps", "--json")
    assert done.exit_code == 0, done.exception
    assert json.loads(done.stdout)["sent"] == {"/odometry": 30, "/dig": 1}
    assert ros.publishers["/odometry"].sent == [data for *_, data in rows[:30]]
    assert ros.publishers["/dig"].messages[0].x == 2.5


@BOTH
def test_one_file_and_a_part_of_it_several_times(
    replay: Callable[..., Result], ros: FakeRos, tmp_path: Path, storage: StoragePlugin
) -> None:
    bag = record(tmp_path / "bag", [odometry(number) for number in range(30)], storage)
    (file,) = (one for one in bag.iterdir() if one.suffix in (".db3", ".mcap"))
    words = ("--speed", "1000", "--start", "1", "--duration", "0.5", "--loop", "2", "--topics", "odometry")
    assert replay(file, *words).exit_code == 0
    assert [message.pose.pose.position.x for message in ros.publishers["/odometry"].messages] == [
        10,
        11,
        12,
        13,
        14,
    ] * 2
    stamps = [
        each.header.stamp.sec * SECOND + each.header.stamp.nanosec for each in ros.publishers["/odometry"].messages
    ]
    assert stamps == sorted(stamps), "tms:sp refuses what is older than its predecessor"


def test_what_is_left_out_is_named_with_the_reason(replay: Callable[..., Result], ros: FakeRos, tmp_path: Path) -> None:
    rows = [
        odometry(0),
        row("/tf_static", "std_msgs/msg/Float64", Float64()),
        row("/zx200/joint_states", "sensor_msgs/msg/JointState", b"\0\1\0\0"),
        row("/dig", "sensing_msgs/msg/Sample", b"\0\1\0\0"),
    ]
    done = replay(record(tmp_path / "bag", rows, StoragePlugin.SQLITE3), "--speed", "1000")
    assert done.exit_code == 0
    assert set(ros.publishers) == {"/odometry"}
    assert "left out /tf_static: no input of sensing.yaml takes it" in done.stderr
    assert "left out /zx200/joint_states: zx200 itself speaks there" in done.stderr
    said = "recorded as sensing_msgs/msg/Sample, but input dig takes sensing_msgs/msg/ExcavateSimple"
    assert f"left out /dig: {said}" in done.stderr


def test_whatever_a_machine_tells_of_itself_is_left_out() -> None:
    """Its pose, too: planners and the console would take the recording for the place of the machine."""
    border = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel).borders["physx"]
    assert {"joint_state", "odom", "base_link/pose", "tracks/cmd_vel", "swing/cmd"} <= set(matching._topics(border))


def test_a_type_that_was_defined_otherwise_is_left_out(replay: Callable[..., Result], tmp_path: Path) -> None:
    rows = [row("/dig", "sensing_msgs/msg/ExcavateSimple", b"\0\1\0\0")]
    other = {"sensing_msgs/msg/ExcavateSimple": SAMPLE}
    done = replay(record(tmp_path / "bag", rows, StoragePlugin.MCAP, other))
    assert done.exit_code == 1
    assert "nothing to play: /dig: recorded with another definition of sensing_msgs/msg/Exc" in str(done.exception)


def test_a_type_that_nobody_knows(replay: Callable[..., Result], tmp_path: Path) -> None:
    given = {"odd": {"topic": "/odd", "type": "no_such_msgs/msg/Odd", "model": "m", "record": "r"}}
    (tmp_path / "sensing.yaml").write_text(yaml.safe_dump({"inputs": given}))
    rows = [row("/odd", "no_such_msgs/msg/Odd", b"\0\1\0\0")]
    done = replay(record(tmp_path / "bag", rows, StoragePlugin.SQLITE3))
    assert "there is no message type no_such_msgs/msg/Odd" in str(done.exception)


def test_a_recording_without_hashes_is_told(tmp_path: Path, replay: Callable[..., Result]) -> None:
    bag = record(tmp_path / "bag", [row("/Flgs", "sensing_msgs/msg/Flgs", Flgs())], StoragePlugin.SQLITE3)
    text = (bag / "metadata.yaml").read_text()
    data = yaml.safe_load(text)
    del data["rosbag2_bagfile_information"]["topics_with_message_count"][0]["topic_metadata"]["type_description_hash"]
    (bag / "metadata.yaml").write_text(yaml.safe_dump(data))
    done = replay(bag, "--speed", "1000")
    assert "/Flgs: the recording does not tell how sensing_msgs/msg/Flgs was laid out" in done.stderr
    assert done.exit_code == 0


def test_bytes_that_are_no_message_are_left_out_and_counted(
    replay: Callable[..., Result], ros: FakeRos, tmp_path: Path
) -> None:
    rows = [odometry(0), row("/odometry", "nav_msgs/msg/Odometry", odometry(1)[3][:50], at=0.1), odometry(2)]
    done = replay(record(tmp_path / "bag", rows, StoragePlugin.SQLITE3), "--speed", "1000")
    assert "/odometry: 1 damaged messages were left out" in done.stderr
    assert len(ros.publishers["/odometry"].sent) == 2


@BOTH
@pytest.mark.parametrize("part", [0.0, 0.3, 0.95])
def test_a_truncated_file(replay: Callable[..., Result], tmp_path: Path, storage: StoragePlugin, part: float) -> None:
    bag = record(tmp_path / "bag", [odometry(number) for number in range(200)], storage)
    (file,) = (one for one in bag.iterdir() if one.suffix in (".db3", ".mcap"))
    file.write_bytes(file.read_bytes()[: int(part * file.stat().st_size)])
    for path in (bag, file):
        done = replay(path)
        assert done.exit_code == 1
        assert "is truncated, damaged or no bag (" in str(done.exception)


def test_a_file_that_is_damaged_inside(replay: Callable[..., Result], tmp_path: Path) -> None:
    bag = record(tmp_path / "bag", [odometry(number) for number in range(200)], StoragePlugin.MCAP)
    data = bytearray((bag / "bag.mcap").read_bytes())
    middle = len(data) // 2
    data[middle : middle + 2000] = b"\xff" * 2000
    (bag / "bag.mcap").write_bytes(data)
    done = replay(bag, "--speed", "1000")
    assert "is truncated, damaged or no bag (" in str(done.exception)


def test_what_is_no_bag(replay: Callable[..., Result], tmp_path: Path) -> None:
    (tmp_path / "notes.db3").write_text("dig here")
    (tmp_path / "notes.txt").write_text("dig here")
    (tmp_path / "old.bag").write_text("#ROSBAG V2.0")
    (tmp_path / "empty").mkdir()
    bag = record(tmp_path / "bag", [odometry(0)], StoragePlugin.SQLITE3)
    (tmp_path / "alone").mkdir()
    shutil.copy(bag / "bag.db3", tmp_path / "alone")
    newer = shutil.copytree(bag, tmp_path / "newer") / "metadata.yaml"
    newer.write_text(newer.read_text().replace("version: 9", "version: 10"))
    for name, said in (
        ("nowhere", "there is no "),
        ("notes.txt", "is no bag: give a bag's folder, or its .db3 or .mcap file"),
        ("notes.db3", "is truncated, damaged or no bag ("),
        ("old.bag", "is a bag of ROS 1: convert it with `rosbags-convert "),
        ("empty", "is no bag: it has no metadata.yaml; give the folder that `ros2 bag record` made"),
        ("alone", "is no bag: it has no metadata.yaml; give its file bag.db3"),
        ("newer", "Rosbag2 version 10 not supported here (up to 9)"),
    ):
        done = replay(tmp_path / name)
        assert done.exit_code == 1, name
        assert said in str(done.exception), name
        assert "Traceback" not in done.output


def test_wishes_that_cannot_be_met(replay: Callable[..., Result], ros: FakeRos, tmp_path: Path) -> None:
    bag = record(tmp_path / "bag", [odometry(number) for number in range(10)], StoragePlugin.SQLITE3)
    assert "no /other in the recording (there: /odometry)" in str(replay(bag, "--topics", "other").exception)
    assert "is 0.9 s long, so nothing begins at 60.0 s" in str(replay(bag, "--start", "60").exception)
    ros.others = 2
    assert "others publish /odometry now" in str(replay(bag).exception)
    for words in (("--speed", "0"), ("--loop", "0"), ("--duration", "-1"), ("--start", "-1")):
        assert replay(bag, *words).exit_code == 2


def test_nobody_hears(replay: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bag = record(tmp_path / "bag", [odometry(0)], StoragePlugin.SQLITE3)
    monkeypatch.setattr(Publisher, "get_subscription_count", lambda _: 0)
    monkeypatch.setattr(player, "READER_LIMIT", 0.0)
    assert "the sensing module does not listen to /odometry; See whether tms:sp runs" in str(replay(bag).exception)


def test_ctrl_c_stops_and_says_how_far_it_came(
    replay: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bag = record(tmp_path / "bag", [odometry(number) for number in range(30)], StoragePlugin.SQLITE3)
    publish = Publisher.publish

    def impatient(self: Publisher, data: bytes) -> None:
        if len(self.sent) == 7:
            raise KeyboardInterrupt
        publish(self, data)

    monkeypatch.setattr(Publisher, "publish", impatient)
    done = replay(bag, "--speed", "1000")
    assert done.exit_code == 1  # click's own; `tms` makes it 130
    assert "stopped after 7 messages" in done.stderr


def test_a_definition_in_the_recording_is_compared_where_it_has_no_hash(tmp_path: Path) -> None:
    bag = record(tmp_path / "bag", [odometry(0)], StoragePlugin.MCAP)
    with Recording(bag / "bag.mcap") as recording:
        (track,) = recording.tracks
        assert track.hash == built_hash("nav_msgs/msg/Odometry")
    with pytest.raises(TmsError, match="there is no"):
        Recording(tmp_path / "nowhere")
