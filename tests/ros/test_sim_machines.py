"""Stand-ins as real processes: what they offer under each backend's names, and faults that are switched on the way."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from com3_msgs.action import SetDumpAngle, SetSwingAngle
from com3_msgs.msg import JointCmd
from geometry_msgs.msg import Twist
from nav2_msgs.action import ComputePathToPose, FollowPath, FollowWaypoints, NavigateThroughPoses, NavigateToPose
from std_msgs.msg import Bool

from stand_in_rig import SITE, Rig, client_in, pose
from tms_ros.goals import Outcome
from tms_ros.node import Ros

pytestmark = [
    pytest.mark.ros,
    pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning"),  # a parser that the ROS wheels bring
]
NAME = "mst110cr_7"  # a name of its own: other tests may have machines in the same domain


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory, domain: int, first_port: int) -> Iterator[Ros]:
    with client_in(tmp_path_factory.mktemp("client"), domain, first_port) as ros:
        yield ros


@pytest.fixture(scope="module")
def carrier(client: Ros, tmp_path_factory: pytest.TempPathFactory, domain: int, first_port: int) -> Iterator[Rig]:
    site = SITE.format(domain=domain, port=first_port + 70, names="sim", machine=NAME, model="mst110cr")
    rig = Rig(client, tmp_path_factory.mktemp("carrier"), NAME, site)
    yield rig
    rig.close()


@pytest.fixture
def machine(carrier: Rig) -> Rig:
    """The carrier in order."""
    carrier.be_in_order()
    carrier.said.clear()
    return carrier


def test_it_tells_where_it_is(machine: Rig) -> None:
    assert list(machine.states[-1].name) == ["rotate_joint", "dump_joint"]
    base = machine.frames[f"{NAME}/base_link"]
    assert base.header.frame_id == "map"
    assert machine.odom[-1].header.frame_id == f"{NAME}/odom"
    assert machine.odom[-1].child_frame_id == f"{NAME}/base_link"
    assert machine.frames[f"{NAME}/dump_bed"].header.frame_id == f"{NAME}/upper_link"


def test_bed_and_body(machine: Rig) -> None:
    tip = machine.send(SetDumpAngle, "set_dump_angle", target_angle=-0.8)
    turn = machine.send(SetSwingAngle, "set_swing_angle", target_angle=1.0)
    assert machine.end(tip) is machine.end(turn) is Outcome.SUCCEEDED
    assert tip.result.success and turn.result.success
    assert list(machine.states[-1].position) == pytest.approx([1.0, -0.8], abs=0.01)
    assert machine.said
    assert machine.end(machine.send(SetDumpAngle, "set_dump_angle", target_angle=-2.0)) is Outcome.REJECTED
    assert machine.end(machine.send(SetDumpAngle, "set_dump_angle", target_angle=0.0)) is Outcome.SUCCEEDED


def test_it_computes_a_path_and_drives_along_it(machine: Rig) -> None:
    begin = machine.place()
    computed = machine.send(ComputePathToPose, "compute_path_to_pose", goal=pose(begin[0] + 3.0, begin[1] + 2.0, 0.5))
    assert machine.end(computed) is Outcome.SUCCEEDED
    path = computed.result.path
    assert len(path.poses) > 5 and {one.header.frame_id for one in path.poses} == {"map"}
    assert math.dist(machine.place(), begin) < 0.01  # a path is no motion
    assert machine.end(machine.send(FollowPath, "follow_path", path=path)) is Outcome.SUCCEEDED
    machine.until(lambda: math.dist(machine.place(), (begin[0] + 3.0, begin[1] + 2.0)) < 0.2, "a frame at the goal")
    assert machine.said[0].distance_to_goal > machine.said[-1].distance_to_goal


def test_it_drives_to_a_pose_and_through_poses(machine: Rig) -> None:
    assert machine.end(machine.send(NavigateToPose, "navigate_to_pose", pose=pose(30, 8, 0.5))) is Outcome.SUCCEEDED
    machine.until(lambda: any(_end(plan) == (30.0, 8.0) for plan in machine.plans), "its way")
    distances = [one.distance_remaining for one in machine.said]
    assert len(distances) > 1 and distances[0] > distances[-1]  # a busy PC tells few of those of a fast stand-in
    machine.until(lambda: math.dist(machine.place(), (30, 8)) < 0.2, "a frame at the goal")
    poses = [pose(26, 8), pose(22, 7), pose(18, 7)]
    through = machine.send(NavigateThroughPoses, "navigate_through_poses", poses=poses)
    assert machine.end(through) is Outcome.SUCCEEDED
    assert {one.number_of_poses_remaining for one in machine.said[len(distances) :]} >= {1, 2}


def test_it_tells_a_way_that_takes_less_than_a_second(machine: Rig) -> None:
    x, y = machine.place()
    end = round(x + 0.5, 3), round(y, 3)
    assert machine.end(machine.send(NavigateToPose, "navigate_to_pose", pose=pose(*end))) is Outcome.SUCCEEDED
    machine.until(lambda: any(_end(plan) == end for plan in machine.plans), "its way")


def _end(plan: Any) -> tuple[float, float]:
    last = plan.poses[-1].pose.position
    return last.x, last.y


def test_a_cancel_ends_with_the_machine_standing(machine: Rig) -> None:
    call = machine.send(NavigateToPose, "navigate_to_pose", pose=pose(80, 7))
    machine.until(lambda: machine.odom[-1].twist.twist.linear.x > 0.5, "motion")
    machine.cancel(NavigateToPose, "navigate_to_pose", call)
    assert machine.end(call) is Outcome.CANCELED
    machine.until(lambda: machine.odom[-1].twist.twist.linear.x == 0.0, "stand-still")


def test_missed_waypoints_are_told_although_it_succeeds(machine: Rig) -> None:
    machine.be(miss=[1])
    x, y = machine.place()
    path = [pose(x + dx, y) for dx in (1, 2, 3)]

    def drive() -> bool:
        call = machine.send(FollowWaypoints, "follow_waypoints", poses=path)
        assert machine.end(call) is Outcome.SUCCEEDED
        return [getattr(one, "index", one) for one in call.result.missed_waypoints] == [1]

    machine.until(drive, "missed waypoint")


def test_a_machine_that_refuses_and_one_that_tells_nothing(machine: Rig) -> None:
    def refused() -> bool:
        machine.be(refuse=["set_dump_angle"], drop_feedback=True)
        return machine.end(machine.send(SetDumpAngle, "set_dump_angle", target_angle=-0.1)) is Outcome.REJECTED

    machine.until(refused, "a refusal")
    machine.said.clear()
    turn = machine.send(SetSwingAngle, "set_swing_angle", target_angle=-1.0)
    assert machine.end(turn) is Outcome.SUCCEEDED
    assert not machine.said


def test_velocity_commands_and_the_emergency_stop(machine: Rig) -> None:
    stop = machine.ros.publisher(Bool, f"/{NAME}/{machine.border.emg_stop}")
    machine.velocity.publish(Twist())
    machine.until(lambda: machine.ros.node.count_subscribers(f"/{NAME}/emg_stop") > 0, "subscription")
    twist = Twist()
    twist.linear.x = 0.5

    def commanded() -> bool:
        machine.velocity.publish(twist)
        return bool(machine.odom[-1].twist.twist.linear.x > 0.4)

    machine.until(commanded, "motion")

    def stopped() -> bool:
        stop.publish(Bool(data=True))
        return bool(machine.odom[-1].twist.twist.linear.x == 0.0)

    machine.until(stopped, "stand-still")
    assert machine.end(machine.send(NavigateToPose, "navigate_to_pose", pose=pose(0, 0))) is Outcome.REJECTED

    def released() -> bool:
        stop.publish(Bool(data=False))
        call = machine.send(SetDumpAngle, "set_dump_angle", target_angle=0.0)
        return machine.end(call) is Outcome.SUCCEEDED

    machine.until(released, "motion afterwards")


def test_joint_commands(machine: Rig) -> None:
    publisher = machine.ros.publisher(JointCmd, f"/{NAME}/{machine.border.joint_cmd}")
    command = JointCmd(joint_name=["rotate_joint", "dump_joint"], control_type=0, position=[0.5, -0.3])

    def there() -> bool:
        publisher.publish(command)
        return list(machine.states[-1].position) == pytest.approx([0.5, -0.3], abs=0.01)

    machine.until(there, "both angles")


def test_it_dies_on_request(client: Ros, tmp_path: Path, domain: int, first_port: int) -> None:
    site = SITE.format(domain=domain, port=first_port + 71, names="physx", machine="ic120_9", model="ic120")
    rig = Rig(client, tmp_path, "ic120_9", site)
    try:
        assert (rig.border.odom, rig.border.cmd_vel, rig.border.emg_stop) == ("odom", "tracks/cmd_vel", None)
        assert list(rig.states[-1].name) == ["vessel_pin_joint"]
        assert "ic120_9_tf/base_link" in rig.frames and rig.odom[-1].child_frame_id == "ic120_9_tf/base_link"
        rig.be(die=1.0)
        rig.until(lambda: rig.ros.node.count_subscribers("/ic120_9/sim/fault") > 0, "subscription")
        rig.be(die=1.0)
        rig.send(SetDumpAngle, "set_dump_angle", target_angle=-1.0)
        rig.until(lambda: rig.process.returncode == 1, "death")
    finally:
        rig.close()
