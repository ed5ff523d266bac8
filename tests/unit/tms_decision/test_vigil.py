"""A stopped machine that moves without a goal is noticed; one shake, or a goal, is not."""

from tms_decision.vigil import LASTS, SETTLED, Vigil

NEVER = float("-inf")


def moving(vigil: Vigil, start: float, seconds: float) -> bool:
    """Whether it is told of a motion that is seen for this long."""
    return any(vigil.left(start + i * 0.05, start + i * 0.05) for i in range(round(seconds / 0.05) + 1))


def test_a_motion_without_a_goal_is_told() -> None:
    vigil = Vigil()
    vigil.begin()
    assert not vigil.left(1.0, NEVER)
    assert moving(vigil, 2.0, LASTS)


def test_one_shake_is_no_motion() -> None:
    vigil = Vigil()
    vigil.begin()
    assert not vigil.left(2.0, 2.0)
    assert not any(vigil.left(2.0 + i * 0.05, 2.0) for i in range(100))


def test_a_goal_may_move_it() -> None:
    vigil = Vigil()
    vigil.begin()
    vigil.end()
    assert not moving(vigil, 2.0, 3.0)


def test_after_a_re_arm_it_is_watched_for_a_while() -> None:
    vigil = Vigil()
    vigil.begin()
    vigil.end(10.0)
    assert moving(vigil, 11.0, 1.0)
    assert not moving(vigil, 10.1 + SETTLED, 3.0)


def test_a_machine_that_was_never_stopped_is_not_watched() -> None:
    vigil = Vigil()
    vigil.end(10.0)
    assert not moving(vigil, 11.0, 3.0)


def test_the_release_of_its_stop_may_move_it_for_a_moment_and_no_longer() -> None:
    vigil = Vigil()
    vigil.begin()
    vigil.end(10.0, 2.0)
    assert not moving(vigil, 10.0, 1.9)
    assert moving(vigil, 12.0, 1.0)


def test_stopped_again_it_is_watched_at_once() -> None:
    vigil = Vigil()
    vigil.begin()
    vigil.end(10.0, 2.0)
    vigil.begin()
    assert moving(vigil, 10.5, 1.0)
