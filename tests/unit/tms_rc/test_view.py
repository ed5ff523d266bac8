"""What a gateway takes from the machine's messages."""

from typing import Any

from geometry_msgs.msg import Quaternion
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, JointState

from tms_rc import view
from tms_rc.standstill import HEADING, PLACE, TURNING


def joints(message: Any) -> Any:
    made: Any = view.View.__new__(view.View)
    made._names = {"swing_joint": "swing_joint", "hook": "boom_joint"}
    return made._joints(message)


def test_joints_are_matched_by_their_names_at_the_border() -> None:
    message = JointState(name=["left_wheel", "hook", "swing_joint"], position=[9.0, 0.5, 0.1], velocity=[9.0, 0.2, 0.0])
    places, speeds = joints(message)
    assert places == {"boom_joint": (0.5,), "swing_joint": (0.1,)}
    assert speeds == {"boom_joint": 0.2, "swing_joint": 0.0}


def test_what_is_not_a_number_was_not_heard() -> None:
    nan = float("nan")
    places, speeds = joints(JointState(name=["swing_joint", "hook"], position=[0.5, nan], velocity=[nan, 0.0]))
    assert places == {"swing_joint": (0.5,)} and speeds == {"boom_joint": 0.0}


def test_joint_states_without_velocities_tell_positions() -> None:
    assert joints(JointState(name=["swing_joint"], position=[0.5])) == ({"swing_joint": (0.5,)}, {})


def odometry(**pose: float) -> Odometry:
    message = Odometry()
    message.pose.pose.position.x = pose.get("x", 0.0)
    message.pose.pose.orientation = Quaternion(z=0.7071067811865476, w=0.7071067811865476)
    message.twist.twist.linear.x, message.twist.twist.angular.z = 0.3, -0.1
    return message


def test_odometry_tells_place_heading_and_speeds() -> None:
    places, speeds = view._odometry(odometry(x=2.0))
    assert places[PLACE] == (2.0, 0.0) and abs(places[HEADING][0] - 1.5708) < 1e-4
    assert speeds == {PLACE: 0.3, HEADING: -0.1}


def test_a_place_that_is_not_a_number_was_not_heard() -> None:
    assert view._odometry(odometry(x=float("inf")))[0] == {}


def test_the_empty_twist_of_a_global_pose_is_no_speed() -> None:
    assert view._global_odometry(odometry())[1] == {}


def test_an_imu_tells_how_it_turns() -> None:
    message = Imu()
    message.angular_velocity.x, message.angular_velocity.z = 0.3, 0.4
    places, speeds = view._imu(message)
    assert places == {TURNING: ()} and abs(speeds[TURNING] - 0.5) < 1e-12
