"""The stand-in of OperaSim-PhysX connected to a real bridge: what ROS sees of it, and what reaches its drives."""

from collections.abc import Iterator
from typing import Any

import pytest
from com3_msgs.msg import JointCmd
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool

from operasim_rig import OperaSim, operasim
from tms_machine.places import Places

pytestmark = [
    pytest.mark.ros,
    pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning"),  # a parser that the ROS wheels bring
]
MACHINE = "zx200_7"  # a name of its own: other tests may have machines in the same domain
FOUR = ["bucket_joint", "arm_joint", "boom_joint", "swing_joint"]  # the last name shows a wrong layout at once


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, domain: int, first_port: int) -> Iterator[OperaSim]:
    with operasim(tmp_path_factory.mktemp("operasim"), domain, first_port + 64, MACHINE, "zx200") as made:
        yield made


def stamp(message: Any) -> float:
    return float(message.header.stamp.sec + message.header.stamp.nanosec * 1e-9)


def test_what_it_tells_arrives(site: OperaSim) -> None:
    states, places, odometry = (
        site.hear(JointState, "joint_state"), site.hear(PoseStamped, "base_link/pose"), site.hear(Odometry, "odom"),
    )  # fmt: skip
    site.until(lambda: len(states) > 5 and places and odometry, "joint states, pose and odometry")
    assert list(states[-1].name) == ["swing_joint", "boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint"]
    assert stamp(states[-1]) - stamp(states[-2]) == pytest.approx(0.04)
    told = places[-1].pose.position  # without z: it falls to the ground at first
    assert [told.x, told.y] == pytest.approx(site.truth()["place"][:2], abs=1e-5)
    assert odometry[-1].child_frame_id == f"{MACHINE}/base_link"
    assert "endpoint_says" in site.log  # c30r is no machine of the site


def test_its_place_is_known_without_frames(site: OperaSim) -> None:
    places = Places(site.ros, {MACHINE: site.border})
    site.until(lambda: places.take() == {MACHINE}, "its place")

    def known() -> bool:
        place, true = places.place(MACHINE), site.truth()
        return place is not None and place[:3] == pytest.approx((*true["place"][:2], true["yaw"]), abs=1e-5)

    site.until(known, "where it really is, once it stands")


def test_front_cmd_moves_the_arm(site: OperaSim) -> None:
    states = site.hear(JointState, "joint_state")
    front = site.speaker(JointCmd, "front_cmd")
    wanted = [0.3, 1.8, -0.9, 0.2]

    def there() -> bool:
        front.publish(JointCmd(joint_name=FOUR, control_type=0, position=wanted))
        told = dict(zip(states[-1].name, states[-1].position, strict=True)) if states else {}
        return bool(told) and all(abs(told[name] - one) < 0.01 for name, one in zip(FOUR, wanted, strict=True))

    site.until(there, "the arm is where it should be")
    assert [site.joint(name)["target"] for name in FOUR] == wanted


def test_tracks_and_stop(site: OperaSim) -> None:
    drive, stop = site.speaker(Twist, "tracks/cmd_vel"), site.speaker(Bool, "emg_stop")
    twist = Twist()
    twist.linear.x = 0.5

    def moving() -> bool:
        drive.publish(twist)
        return bool(site.truth()["tracks"]["left"] > 0.2)

    site.until(moving, "it drives")

    def stopped() -> bool:
        stop.publish(Bool(data=True))
        return bool(site.truth()["stopped"])

    site.until(stopped, "it is stopped")
    site.until(lambda: site.truth()["tracks"] == {"left": 0.0, "right": 0.0}, "it stands")
    stop.publish(Bool(data=False))
    site.until(lambda: not site.truth()["stopped"], "it is released")


def test_a_lost_connection_comes_back(site: OperaSim) -> None:
    states = site.hear(JointState, "joint_state")
    connections = site.log.count("event=handshake")
    site.until(lambda: states, "joint states")
    site.command("cut 0.2")
    site.until(lambda: site.log.count("event=handshake") > connections, "a new connection")
    again = site.command("state")["time"]
    site.until(lambda: stamp(states[-1]) > again, "joint states of now")
    assert [stamp(one) for one in states] == sorted(stamp(one) for one in states)


def test_after_a_restart_its_time_begins_anew(site: OperaSim) -> None:
    states = site.hear(JointState, "joint_state")
    site.until(lambda: states and stamp(states[-1]) > 1.5, "some time")
    site.command("restart 0.2")
    site.until(lambda: stamp(states[-1]) < 1.5, "joint states of the new start")
    assert states[-1].position[0] == 0.0
