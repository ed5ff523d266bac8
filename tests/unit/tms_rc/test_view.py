"""What a gateway takes from the machine's messages."""

from typing import Any

from sensor_msgs.msg import JointState

from tms_core.models import Still
from tms_rc.node import View
from tms_rc.standstill import StandStill


def view(watch: StandStill) -> Any:
    made = View.__new__(View)
    made._watch, made._names = watch, {"swing_joint": "swing_joint", "boom_joint": "boom_joint"}
    return made


def test_what_is_not_a_number_was_not_heard() -> None:
    watch = StandStill(Still(velocity=0.01, seconds=0.2))
    nan = float("nan")
    message = JointState(name=["swing_joint", "boom_joint"], position=[0.5, nan], velocity=[nan, 0.0])
    view(watch)._joints_heard([message])
    assert watch.positions == {"swing_joint": 0.5}
    assert watch.velocities == {}  # from its positions, later


def test_joints_of_somebody_else_are_no_news() -> None:
    watch = StandStill(Still(velocity=0.01, seconds=0.2))
    view(watch)._joints_heard([JointState(name=["left_wheel"], position=[0.5], velocity=[0.0])])
    assert watch.moving()
    assert watch.age(1.0) == float("inf")
    assert watch.positions == {}
