"""Joints that do not follow are told within dead time, lag and a second; those that do are left alone."""

from collections.abc import Callable

import pytest

from tms_proof.following import BEHIND, OFF_PATH, QUIET, QUIET_ANGLE, SMALLEST, Follower, Way, ways
from tms_proof.reasons import OffPath, Stalled
from tms_reason.reason import Reason

DEAD, LAG, LOOK = 0.9, 1.0, 0.1  # s
NAMES = ("swing", "boom")
POINTS = [(0.0, (0.0, 0.5)), (2.0, (0.8, 0.5)), (4.0, (0.8, -0.1))]
START = {"swing": 0.0, "boom": 0.5}


def watched(
    joint: Callable[[float, Way], float], points: list[tuple[float, tuple[float, ...]]] = POINTS, limit: float = 12.0
) -> tuple[float, Reason | None]:
    """When something is told of a machine whose joints are where `joint` says, and what; infinite for nothing."""
    found = ways(NAMES, points, START)
    follower = Follower(found, DEAD + LAG, 100.0)
    for i in range(round(limit / LOOK)):
        time = i * LOOK
        wrong = follower.check(100.0 + time, {name: joint(time, way) for name, way in found.items()})
        if wrong is not None:
            return time, wrong
    return float("inf"), None


@pytest.mark.parametrize("late", [0.0, 0.3, DEAD, DEAD + LAG])
def test_a_machine_that_follows_is_left_alone(late: float) -> None:
    assert watched(lambda time, way: way.at(time - late)) == (float("inf"), None)


def test_a_machine_that_never_moves_is_stalled() -> None:
    when, what = watched(lambda time, way: way.at(0.0))
    assert when <= DEAD + LAG + 1.0
    assert isinstance(what, Stalled) and (what.joint, what.angle) == ("swing", 0.0)


def test_a_stall_on_the_way_is_told_within_a_second_more() -> None:
    when, what = watched(lambda time, way: way.at(min(time - DEAD, 1.0)))
    assert 1.0 + DEAD < when <= 1.0 + DEAD + DEAD + LAG + 1.0
    assert isinstance(what, Stalled) and what.joint == "swing"


def test_a_joint_that_stands_short_of_its_goal_is_stalled() -> None:
    _, what = watched(lambda time, way: max(way.at(time - DEAD), 0.1) if way.angles[0] else way.at(time - DEAD))
    assert isinstance(what, Stalled) and (what.joint, what.angle) == ("boom", pytest.approx(0.1))


def test_the_wrong_way_is_off_the_path() -> None:
    when, what = watched(lambda time, way: 2 * way.angles[0] - way.at(time - DEAD))
    assert isinstance(what, OffPath) and what.joint == "swing" and -0.3 < what.angle < -0.2
    assert when < DEAD + 1.0


def test_a_joint_that_goes_on_behind_its_end_is_off_the_path() -> None:
    _, what = watched(lambda time, way: 0.4 * max(0.0, time - DEAD) if way.angles[0] == 0 else way.at(time - DEAD))
    assert isinstance(what, OffPath) and what.joint == "swing"


def test_a_joint_that_turns_may_be_told_a_turn_away() -> None:
    found = ways(["swing"], [(0.0, (0.1,)), (1.0, (0.6,))], {"swing": 6.3831853})
    assert found["swing"].angles[-1] == pytest.approx(6.8831853)


def test_a_motion_is_to_be_seen_once_its_reference_has_moved() -> None:
    follower = Follower(ways(NAMES, POINTS, START), DEAD + LAG, 100.0)
    assert not follower.should_have_moved(0.0)
    assert follower.should_have_moved(0.1)


def test_what_was_commanded_before_dead_time_and_lag_must_have_come() -> None:
    follower = Follower({"boom": Way([0.0, 2.0], [0.5, 0.1])}, DEAD + LAG, 100.0)
    running = [(late, late, late - DEAD - LAG) for late in (DEAD + LAG, 1.0 + DEAD + LAG, 2.0 + DEAD + LAG)]
    over = [(0.5, 0.5 + DEAD + LAG, 0.5), (0.5, 5.0, 0.5), (2.0, 2.0 + DEAD, 2.0 - LAG), (10.0, 10.0, 2.0)]
    for end, now, seconds in running + over:
        expected = {"boom": (0.5, pytest.approx(0.2 * seconds))}
        assert follower.behind(100.0 + end, 100.0 + now) == expected, (end, now)


def test_what_is_on_its_way_is_a_joint_s_own_dead_time_by_either_kind_of_controller() -> None:
    follower = Follower(ways(NAMES, POINTS, START), DEAD + LAG, 100.0)
    on_its_way = follower.on_its_way(103.0, {"swing": 0.9, "boom": 0.3}, 103.0)
    assert on_its_way["swing"] == pytest.approx(0.0)  # it has arrived 1 s ago
    assert on_its_way["boom"] == pytest.approx(0.09)  # 0.3 rad/s
    begins = follower.on_its_way(102.5, {"swing": 0.9, "boom": 0.3}, 102.5)
    assert begins["swing"] == pytest.approx(0.16)
    assert begins["boom"] == pytest.approx(0.0)  # led 0.6 s later, it has not been commanded yet


@pytest.mark.parametrize(("now", "boom"), [(102.9, 0.09), (103.0, 0.06), (103.1, 0.03), (103.3, 0.0)])
def test_what_was_commanded_before_a_goal_was_over_is_on_its_way_for_the_dead_time(now: float, boom: float) -> None:
    follower = Follower(ways(NAMES, POINTS, START), DEAD + LAG, 100.0)
    on_its_way = follower.on_its_way(now, {"swing": 0.3, "boom": 0.3}, 102.9)
    assert on_its_way["boom"] == pytest.approx(boom)


def test_what_is_heard_must_change_while_the_reference_moves() -> None:
    follower = Follower(ways(NAMES, POINTS, START), DEAD + LAG, 100.0)
    assert follower.moved(103.0, 1.0) and not follower.moved(106.0, 1.0)


def test_a_goal_that_asks_for_no_motion_changes_nothing() -> None:
    follower = Follower(ways(NAMES, [(60.0, (0.0, 0.5))], START), DEAD + LAG, 100.0)
    assert not follower.moved(130.0, 20.0)
    assert follower.check(130.0, START) is None


def test_a_joint_that_is_not_told_is_not_judged() -> None:
    made = ways(["boom", "unknown"], [(1.0, [0.5, 0.5])], {"boom": 0.0})
    assert list(made) == ["boom"]
    assert Follower(made, 0.1, 0.0).check(10.0, {"arm": 0.0}) is None


# a reference


def test_a_reference_that_steps_has_both_angles_at_this_moment() -> None:
    steps = Way([0.0, 1.0, 1.0, 2.0], [0.0, 0.0, 1.0, 1.0])
    assert (steps.at(0.5), steps.at(1.0)) == (0.0, 1.0)
    assert steps.hull(1.0, 2.0) == (0.0, 1.0)


def test_a_reference_has_passed_where_it_turned_back() -> None:
    assert Way([0.0, 1.0, 2.0], [0.0, 1.0, 0.0]).hull(0.0, 2.0) == (0.0, 1.0)


def test_joints_that_are_not_known_hide_no_others() -> None:
    assert list(ways(["unknown", "boom"], [(1.0, [0.5, 0.5])], {"boom": 0.0})) == ["boom"]
    follower = Follower({"arm": ONE, "boom": ONE}, 0.0, 0.0)
    assert follower.check(0.0, {"boom": 5.0}) == OffPath("boom", 5.0, 1.0, 1.0)


def test_a_turn_is_added_to_where_the_joint_was() -> None:
    assert ways(["swing"], [(0.0, (-2.78,)), (1.0, (-2.0,))], {"swing": 3.5})["swing"].angles[-1] > 4.0


# a motion at its bounds


ONE = Way([0.0, 100.0], [1.0, 1.0])  # stays at 1 rad


def test_a_reference_that_hardly_moves_need_not_show() -> None:
    assert not Follower({"boom": Way([0.0, 1.0], [0.0, SMALLEST])}, 0.0, 0.0).should_have_moved(1.0)
    assert not Follower({"boom": Way([0.0, 1.0], [0.0, BEHIND])}, 0.0, 0.0).moved(1.0, 1.0)


def test_nothing_is_on_its_way_to_no_joint() -> None:
    assert Follower({}, 0.0, 0.0).on_its_way(1.0, {}, 1.0) == {}


def quiet(way: Way, *angles: float, reached: float = 0.0, now: float = 0.0, scale: float = 1.0) -> Reason | None:
    """What is said of a joint that was at these angles for as long as a joint must not be quiet, until `now`."""
    follower, wrong = Follower({"boom": way}, reached, 0.0, scale), None
    for angle, at in zip(angles, (now - QUIET, now), strict=True):
        wrong = follower.check(at, {"boom": angle})
    return wrong


@pytest.mark.parametrize("off", [-BEHIND, BEHIND])
def test_a_joint_that_is_a_little_off_may_stand(off: float) -> None:
    assert quiet(ONE, 1.0 + off, 1.0 + off, now=QUIET) is None
    assert quiet(ONE, 1.0 + 1.1 * off, 1.0 + 1.1 * off, now=QUIET) == Stalled("boom", 1.0 + 1.1 * off, 1.0)


@pytest.mark.parametrize("off", [-OFF_PATH, OFF_PATH])
def test_a_joint_may_be_off_its_path_up_to_a_limit(off: float) -> None:
    assert Follower({"boom": ONE}, 0.0, 0.0).check(0.0, {"boom": 1.0 + off}) is None
    assert Follower({"boom": ONE}, 0.0, 0.0).check(0.0, {"boom": 1.0 + 1.1 * off}) is not None


def test_a_joint_that_stands_may_jitter() -> None:
    assert isinstance(quiet(ONE, 0.0, QUIET_ANGLE, now=QUIET), Stalled)
    assert isinstance(quiet(ONE, 0.5, 0.6, now=QUIET), OffPath)


def test_what_a_joint_did_before_it_was_quiet_does_not_count() -> None:
    follower = Follower({"boom": ONE}, 0.0, 0.0)
    for at, angle in ((-0.5, 0.85), (0.0, 0.9)):
        assert follower.check(at, {"boom": angle}) is None
    assert isinstance(follower.check(QUIET, {"boom": 0.9}), Stalled)


@pytest.mark.parametrize(("angle", "due"), [(2.0, 1.0), (-2.0, -1.0)])
def test_a_stalled_joint_should_have_passed_the_nearest_angle_of_its_reference(angle: float, due: float) -> None:
    turns = Way([0.0, 1.0, 3.0], [-1.0, -1.0, 1.0])
    assert quiet(turns, angle, angle, reached=1.0, now=2.0) == Stalled("boom", angle, due)


def test_a_controller_may_run_ahead_of_its_reference() -> None:
    ahead = 0.55  # rad, where the reference is at 0.4
    assert quiet(Way([0.0, 10.0], [0.0, 2.0]), ahead, ahead, reached=0.5, now=2.0) is None


def test_where_a_joint_should_not_be_yet_is_off_its_path() -> None:
    early = Follower({"boom": Way([0.0, 10.0], [0.0, 2.0])}, 0.0, 100.0)
    assert early.check(100.0, {"boom": 2.0}) == OffPath("boom", 2.0, 0.0, pytest.approx(0.2))


# a stand-in, four times as fast


def test_a_reference_of_a_stand_in_passes_in_its_own_time() -> None:
    follower = Follower({"boom": Way([0.0, 1.0, 4.0, 8.0], [0.0, 0.0, 0.0, 1.0])}, 0.0, 0.0, 4.0)
    assert follower.moved(2.0, 1.0) and not follower.moved(1.0, 1.0)
    assert follower.should_have_moved(1.5) and not follower.should_have_moved(1.0)


def test_a_stand_in_is_stalled_and_off_its_path_in_its_own_time() -> None:
    steady = Way([0.0, 40.0], [0.0, 8.0])  # 0.8 rad in a second of ours
    assert isinstance(quiet(steady, 0.0, 0.0, now=1.0, scale=4.0), Stalled)
    assert quiet(steady, 2.3, 2.3, now=2.0, scale=4.0) is None
    assert Follower({"boom": steady}, 0.0, 0.0, 4.0).check(1.0, {"boom": 1.7}) is None
