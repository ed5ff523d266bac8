"""When a machine counts as standing, and how far it went."""

from tms_core.models import Still
from tms_rc.standstill import JOINTS, ODOM, StandStill

STILL = Still(velocity=0.01, seconds=0.2)


def fed(*states: tuple[float, float, float]) -> StandStill:
    """Joint states (time s, position rad, velocity rad/s) of one joint."""
    watch = StandStill(STILL)
    for now, position, velocity in states:
        watch.update(now, {"swing": position}, {"swing": velocity})
    return watch


def test_nothing_heard_is_not_standing() -> None:
    watch = StandStill(STILL)
    assert not watch.standing(0.0)
    assert watch.age(5.0) == float("inf")


def test_it_stands_after_it_was_slow_for_long_enough() -> None:
    watch = fed((0.0, 0.0, 1.0), (0.1, 0.1, 0.0), (0.25, 0.1, 0.0))
    assert not watch.standing(0.25)
    watch.update(0.31, {"swing": 0.1}, {"swing": 0.005})
    assert watch.standing(0.31)


def test_a_new_motion_starts_the_wait_again() -> None:
    watch = fed((0.0, 0.0, 0.0), (0.3, 0.0, 0.5), (0.4, 0.1, 0.0))
    assert not watch.standing(0.45)


def test_silence_is_not_standing() -> None:
    assert not fed((0.0, 0.0, 0.0)).standing(2.0)


def test_velocity_from_positions_when_the_machine_sends_none() -> None:
    watch = StandStill(STILL)
    watch.update(0.0, {"swing": 0.0}, {})
    watch.update(0.1, {"swing": 0.1}, {})
    assert watch.moving()
    assert abs(watch.velocities["swing"] - 1.0) < 1e-9


def test_travel_counts_from_the_mark() -> None:
    watch = fed((0.0, 1.0, 1.0))
    watch.mark()
    watch.update(0.1, {"swing": 1.3}, {"swing": 1.0})
    watch.update(0.2, {"swing": 1.1}, {"swing": 0.0})
    assert abs(watch.travel() - 0.3) < 1e-9


def test_a_machine_that_drives_does_not_stand() -> None:
    watch = StandStill(STILL, (JOINTS, ODOM))
    watch.update(0.0, {"swing": 0.0}, {"swing": 0.0})
    assert not watch.standing(0.3)  # no odometry yet
    assert watch.silent(0.0, 1.0) == "no odometry from the machine yet"
    watch.update_odometry(0.1, (0.0, 0.0), 0.5, 0.0)
    watch.mark()
    watch.update_odometry(0.2, (0.3, 0.4), 0.0, 0.0)
    watch.update(0.4, {"swing": 0.0}, {"swing": 0.0})
    assert watch.standing(0.4)
    assert abs(watch.travel() - 0.5) < 1e-9


def test_turning_on_the_spot_is_moving() -> None:
    watch = StandStill(STILL, (ODOM,))
    watch.update_odometry(0.0, (0.0, 0.0), 0.0, 0.5)
    assert watch.moving()


def test_what_holds_no_joint_of_the_machine_is_no_news_of_it() -> None:
    watch = StandStill(STILL)
    for now in (0.0, 0.1, 0.2, 0.3):
        watch.update(now, {}, {})
    assert not watch.standing(0.3)
    assert watch.silent(0.3, 1.0) == "no joint states from the machine yet"


def test_a_joint_that_is_not_told_any_more_is_not_seen_to_stand() -> None:
    watch = fed((0.0, 0.0, 0.0), (0.1, 0.0, 0.0))
    for now in range(2, 20):
        watch.update(now / 10, {"bucket": 0.0}, {"bucket": 0.0})
    assert not watch.standing(1.9)
    assert watch.silent(1.9, 1.0) == "joint states 1.8 s old"


def test_the_speed_of_a_joint_that_comes_less_often_is_from_its_own_last_position() -> None:
    watch = StandStill(STILL)
    watch.update(0.0, {"swing": 0.0}, {})
    watch.update(0.3, {"bucket": 0.0}, {})
    watch.update(0.4, {"swing": 0.4}, {})
    assert abs(watch.velocities["swing"] - 1.0) < 1e-9
