"""A scene of the stand-in of OperaSim-PhysX: rates, stamps, frames, and messages as ROS reads and writes them."""

import math
from collections import defaultdict
from typing import Any

import pytest
from com3_msgs.msg import JointCmd
from geometry_msgs.msg import PoseStamped, QuaternionStamped, Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, JointState, NavSatFix
from std_msgs.msg import Bool, Float64, Float64MultiArray, MultiArrayDimension

from operasim import model
from operasim.cdr import Writer
from operasim.model import Unknowns
from operasim.outputs import Interval
from operasim.world import World
from tms_ros.packing import pack, unpack

FRAME = 1 / 60


class Run:
    """A scene and what it sends."""

    def __init__(self, scene: str = "SimpleScene", layout: Any = "control_type") -> None:
        self.sent: dict[str, list[bytes]] = defaultdict(list)
        self.troubles: list[tuple[str, str]] = []
        self.world = World(
            model.scene(scene), Unknowns(), layout, lambda topic, data: self.sent[topic].append(data), self._trouble
        )

    def go(self, seconds: float, *heard: tuple[str, Any], frame: float = FRAME) -> None:
        """Go on; what is heard is heard in the first frame."""
        self.world.frame(frame, [(topic, one if isinstance(one, bytes) else pack(one)) for topic, one in heard])
        for _ in range(round(seconds / frame) - 1):
            self.world.frame(frame, [])

    def last(self, topic: str, kind: Any) -> Any:
        return unpack(self.sent[topic][-1], kind)

    def target(self, machine: str, joint: str) -> float:
        found = self.world.truth()["machines"][machine]["joints"][joint]["target"]
        assert isinstance(found, float)
        return found

    def _trouble(self, topic: str, why: str) -> None:
        self.troubles.append((topic, why))


@pytest.fixture(scope="module")
def minute() -> Run:
    """A minute of all machines at 60 frames a second."""
    run = Run("AllMachines")
    run.go(60.0)
    return run


@pytest.mark.parametrize(
    ("topic", "rate"),
    [
        ("zx200/joint_state", 25), ("zx120/joint_states", 25), ("ic120/joint_states", 50),
        ("mst110cr/joint_states", 50),
        ("zx200/odom", 50), ("mst110cr/odom_pose", 50), ("c30r/odom", 50), ("zx200/base_link/pose", 16.67),
        ("ic120/base_link/pose", 16.67), ("c30r/base_link/pose", 16.67), ("mst110cr/global_pose", 8.33),
        ("zx120/gnss_compass/heading", 10), ("/zx120/gnss_compass/fix", 8.33), ("clock", 30),
        ("/zx120/boom/g2_imu", 60), ("/zx120/bucket/g2_imu_sim", 60),
    ],
)  # fmt: skip
def test_rates(minute: Run, topic: str, rate: float) -> None:
    assert len(minute.sent[topic]) / 60 == pytest.approx(rate, rel=0.01)


def test_no_topic_of_c30rs_vessel_no_tf_and_no_soil(minute: Run) -> None:
    assert not {"/tf", "c30r/joint_states", "zx200_groundtruth"} & set(minute.sent)
    assert len(minute.sent) == 3 + 9 + 3 + 3 + 2 + 1


@pytest.mark.parametrize(
    ("period", "steps"), [(0.02, 1), (0.04, 2), (0.05, 3), (0.09, 5), (0.1, 6)]
)  # 0.1 s: five single-precision steps of 0.02 are a little less
def test_periods_in_steps(period: float, steps: int) -> None:
    interval = Interval(period)
    assert [interval.due(0.02) for _ in range(2 * steps)] == ([False] * (steps - 1) + [True]) * 2


def test_stamps_are_multiples_of_a_step_since_the_start(minute: Run) -> None:
    stamps = [unpack(one, Odometry).header.stamp for one in minute.sent["ic120/odom"]]
    assert all(stamp.nanosec % 20_000_000 == 0 for stamp in stamps)
    assert (stamps[0].sec, stamps[0].nanosec) == (0, 20_000_000)
    clocks = [unpack(one, Clock).clock for one in minute.sent["clock"]]
    times = [one.sec + one.nanosec * 1e-9 for one in clocks]
    assert times == sorted(times)
    assert times[-1] == pytest.approx(60.0, abs=0.05)


@pytest.mark.parametrize(
    ("topic", "frames"),
    [
        ("zx200/odom", ("zx200_tf/odom", "zx200/base_link")), ("zx120/odom", ("zx120_tf/odom", "zx120_tf/base_link")),
        ("ic120/odom", ("ic120_tf/odom", "ic120_tf/base_link")),
        ("mst110cr/odom_pose", ("mst110cr_tf/odom", "mst110cr/base_link")), ("mst110cr/global_pose", ("map", "")),
    ],
)  # fmt: skip
def test_frames_are_as_odd_as_the_originals(minute: Run, topic: str, frames: tuple[str, str]) -> None:
    message = minute.last(topic, Odometry)
    assert (message.header.frame_id, message.child_frame_id) == frames


def test_covariances(minute: Run) -> None:
    odometry, truth = minute.last("ic120/odom", Odometry), minute.last("mst110cr/global_pose", Odometry)
    for covariance in (odometry.pose.covariance, odometry.twist.covariance):
        assert [covariance[7 * i] for i in range(6)] == [0.001, 0.001, 1e6, 1e6, 1e6, 1000.0]
        assert sum(covariance) == pytest.approx(3001000.002)
    assert [truth.pose.covariance[7 * i] for i in range(6)] == [0.5, 0.5, 0.5, 0.1, 0.1, 0.1]
    assert not any(truth.twist.covariance)


@pytest.mark.parametrize(
    ("topic", "names"),
    [
        ("zx200/joint_state", ["swing_joint", "boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint"]),
        ("mst110cr/joint_states", ["rotate_joint", "vessel_cylinder_joint", "vessel_rod_joint", "dump_joint"]),
        ("ic120/joint_states", ["vessel_pin_joint"]),
        (
            "zx120/joint_states",
            [
                "swing_joint", "boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint", "joint10", "joint8",
                "joint5", "joint6",
            ],
        ),
    ],
)  # fmt: skip
def test_joint_names(minute: Run, topic: str, names: list[str]) -> None:
    message = minute.last(topic, JointState)
    assert (list(message.name), message.header.frame_id) == (names, "world")
    assert list(message.effort) == [0.0] * len(names)
    assert len(message.position) == len(message.velocity) == len(names)


def test_places_at_the_start() -> None:
    run = Run()
    run.go(2.0)
    places = {name: run.last(f"{name}/base_link/pose", PoseStamped) for name in ("zx200", "zx120", "ic120", "c30r")}
    told = {name: (one.pose.position.x, one.pose.position.y) for name, one in places.items()}
    assert told["zx200"] == pytest.approx((-13.85, -9.17), abs=1e-5)
    assert told["zx120"] == pytest.approx((-14.31, -3.19), abs=1e-5)
    assert told["ic120"] == pytest.approx((0.0, -3.77), abs=1e-5)
    turn = places["c30r"].pose.orientation
    assert math.degrees(2 * math.atan2(turn.z, turn.w)) == pytest.approx(46.14)
    assert all(one.header.frame_id == "world" for one in places.values())


def test_imus_and_gnss(minute: Run) -> None:
    imu = minute.last("/zx120/boom/g2_imu", Imu)
    boom = minute.world.truth()["machines"]["zx120"]["joints"]["boom_joint"]["position"]
    assert 2 * math.atan2(imu.orientation.y, imu.orientation.w) == pytest.approx(boom)
    assert math.hypot(imu.linear_acceleration.x, imu.linear_acceleration.z) == pytest.approx(9.81)
    fix = minute.last("/zx120/gnss_compass/fix", NavSatFix)
    assert fix.status.status == 1
    assert fix.latitude == pytest.approx(36.073406 + math.degrees((-14.31 - 53.8) / 6378137.0), abs=1e-6)
    assert fix.longitude < 140.041676  # it stands further to the west: y of ROS
    assert minute.last("zx120/gnss_compass/heading", QuaternionStamped).header.frame_id == "map"


def test_a_long_frame_loses_time() -> None:
    run = Run()
    run.go(5.0, frame=5.0)
    assert run.world.time == pytest.approx(0.333)
    assert len(run.sent["ic120/odom"]) == 16


def test_commands_have_effect_in_the_next_step() -> None:
    run = Run()
    run.go(1.0)
    twist = Twist()
    twist.linear.x, twist.angular.z = 0.5, 0.1
    run.go(10.0, ("ic120/tracks/cmd_vel", twist), ("ic120/vessel/cmd", Float64(data=-0.5)))
    assert run.last("ic120/odom", Odometry).twist.twist.linear.x == pytest.approx(0.5, abs=0.01)
    assert run.last("ic120/odom", Odometry).twist.twist.angular.z == pytest.approx(0.1 / 3, abs=0.002)
    assert run.target("ic120", "vessel_pin_joint") == -0.5


def test_one_legacy_message_moves_two_machines() -> None:
    run = Run()
    run.go(1.0, ("move_group/fake_controller_joint_states", JointState(name=["boom_joint"], position=[-0.3])))
    assert [run.target(name, "boom_joint") for name in ("zx200", "zx120")] == [-0.3, -0.3]


def test_stop_and_drive_params() -> None:
    run = Run()
    params = Float64MultiArray(data=[1e6, 2e6])
    params.layout.dim.append(MultiArrayDimension(label="odd", size=2, stride=2))
    run.go(0.1, ("zx200/emg_stop", Bool(data=True)), ("/zx200/unity/drive_params", params))
    assert run.world.truth()["machines"]["zx200"]["stopped"]
    bucket = run.world.machines["zx200"].joints["bucket_joint"]
    assert bucket is not None
    assert (bucket.stiffness, bucket.damping) == (1e6, 2e6)


def test_track_cmd_has_no_limit() -> None:
    run = Run()
    run.go(0.1, ("zx200/track_cmd", JointCmd(joint_name=["right_track", "left_track"], velocity=[4.0, 5.0])))
    tracks = run.world.machines["zx200"].tracks
    assert (tracks.left.command, tracks.right.command) == (5.0, 4.0)


def test_both_layouts_of_joint_cmd() -> None:
    plain = Writer().strings(["bucket_joint", "swing_joint"]).doubles([0.3, 0.4]).doubles([]).doubles([]).message
    ours = JointCmd(joint_name=["bucket_joint", "swing_joint"], position=[0.3, 0.4])
    for layout, message in (("plain", plain), ("control_type", ours)):
        run = Run(layout=layout)
        run.go(2.0, ("zx200/front_cmd", message))
        assert (run.target("zx200", "bucket_joint"), run.target("zx200", "swing_joint")) == (0.3, 0.4)
        assert run.troubles == []


def test_the_other_layout_reads_positions_as_empty_after_a_name_of_eleven_letters() -> None:
    names = Writer().strings(["bucket_joint", "swing_joint"])
    ours = names.put("B", 0).doubles([0.3, 0.4]).doubles([]).doubles([])  # rclpy leaves any bytes in the gaps
    run = Run(layout="plain")
    run.go(2.0, ("zx200/front_cmd", ours.message))
    assert run.troubles == [("zx200/front_cmd", "less values than names")]
    assert run.target("zx200", "bucket_joint") == pytest.approx(math.radians(45))


def test_a_damaged_message_is_told_and_ignored() -> None:
    run = Run()
    run.go(0.1, ("zx200/tracks/cmd_vel", b"\0\1\0\0\0"), ("zx200/emg_stop", b"\0\0\0\0\1"), ("nobody/hears", b""))
    assert [topic for topic, _ in run.troubles] == ["zx200/tracks/cmd_vel", "zx200/emg_stop"]
