"""Where a machine is by its poses, and when these are not believed."""

import math

import pytest

from tms_areas.fix import FIX_OLD, OLD, RTK, SETTLED, TOLD, VAGUE, Fix, Seen
from tms_areas.reasons import FixLost, FixOld, PoseJumped, PoseOld, PoseSettles, PoseStuck, PoseUnknown, PoseVague
from tms_reason.reason import Reason

PERIOD = 0.06  # s


def drive(
    fix: Fix, begin: float, seconds: float, x: float = 0.0, speed: float = 0.5
) -> tuple[float, float, Reason | None]:
    """Poses of a machine that drives along x; returns when and where it is then, and what was seen at the end."""
    now = begin
    for _ in range(round(seconds / PERIOD)):
        now, x = now + PERIOD, x + speed * PERIOD
        fix.heard(now, x, 0.0, 0.0)
        fix.look(now)
    return now, x, fix.look(now).unsure


def driving() -> tuple[Fix, float, float]:
    fix = Fix(0.4)
    fix.odometry(0.5, 0.0)
    now, x, wrong = drive(fix, 0.0, 8.0)
    assert wrong is None
    return fix, now, x


def test_a_line_through_the_poses_tells_place_and_speed() -> None:
    fix, now, x = driving()
    motion = fix.look(now + 0.02).motion
    assert motion is not None and motion.age == pytest.approx(0.02)
    assert (motion.x, motion.vx, motion.vy, motion.turning) == pytest.approx((x, 0.5, 0.0, 0.0), abs=1e-6)


def test_a_heading_that_wraps_turns_on() -> None:
    fix = Fix(0.4)
    for i in range(20):
        fix.heard(i * PERIOD, 0.0, 0.0, math.remainder(math.pi - 0.1 + 0.02 * i, math.tau))
        fix.look(i * PERIOD)
    assert fix.motion is not None and fix.motion.turning == pytest.approx(0.02 / PERIOD)


def test_nothing_is_known_before_poses_and_five_seconds_of_them() -> None:
    fix = Fix(0.4)
    assert fix.look(0.0) == Seen(PoseUnknown(), None)
    assert isinstance(drive(fix, 0.0, SETTLED - 0.2)[2], PoseSettles)


def test_an_old_pose_and_five_seconds_of_new_ones() -> None:
    fix, now, x = driving()
    assert fix.look(now + OLD - 0.01).unsure is None
    assert isinstance(fix.look(now + OLD + 0.01).unsure, PoseOld)
    then, x, wrong = drive(fix, now + 3.0, SETTLED - 0.2, x)
    assert isinstance(wrong, PoseSettles) and isinstance(wrong.why, PoseOld)
    assert drive(fix, then, 0.5, x)[2] is None


def test_a_jump_is_not_believed_and_the_last_place_stays() -> None:
    fix, now, x = driving()
    fix.heard(now + PERIOD, x + 0.6, 0.0, 0.0)
    wrong = fix.look(now + 2 * PERIOD).unsure
    assert isinstance(wrong, PoseSettles) and wrong.why == PoseJumped()
    motion = fix.look(now + PERIOD).motion
    assert motion is not None and motion.x == pytest.approx(x)


@pytest.mark.parametrize("turn", [0.3, -0.3])
def test_a_heading_that_jumps(turn: float) -> None:
    fix, now, x = driving()
    fix.heard(now + PERIOD, x + 0.03, 0.0, turn)
    assert fix.look(now + PERIOD).unsure is not None


def test_one_that_is_no_number_is_a_place_that_nobody_knows() -> None:
    fix, now, _ = driving()
    fix.heard(now + PERIOD, math.nan, 0.0, 0.0)
    assert fix.look(now + PERIOD).unsure is not None


def test_the_same_pose_to_the_last_bit_is_no_news_while_the_tracks_move() -> None:
    fix, now, x = driving()
    fix.odometry(0.0, 0.0)
    now, x, wrong = drive(fix, now, 2.0, x, speed=0.0)
    assert wrong is None
    fix.odometry(0.5, 0.0)
    assert isinstance(drive(fix, now, OLD + 0.2, x, speed=0.0)[2], PoseStuck)


def test_poses_that_are_spread_make_the_place_unsure() -> None:
    fix, now, x = driving()
    sure = fix.look(now).motion
    for i in range(40):
        fix.heard(now + (i + 1) * PERIOD, x, 0.03 * (-1) ** i, 0.0)
        fix.look(now + (i + 1) * PERIOD)
    unsure = fix.look(now).motion
    assert sure is not None and unsure is not None and unsure.off > sure.off + 0.05


def test_a_machine_that_stands_may_tell_its_place_less_often() -> None:
    fix = Fix(0.4)
    for i in range(20):
        fix.heard(0.4 * i, 1.0, 2.0, 0.0)
    at = 0.4 * 19
    assert fix.look(at + 0.39) == Seen(None, fix.motion) and fix.motion is not None and fix.motion.rests
    fix.odometry(0.3, 0.0)  # it leaves, and nobody says where to
    assert isinstance(fix.look(at + OLD + 0.01).unsure, PoseOld)


def test_one_that_moves_by_its_poses_tells_its_place_often_whatever_its_odometry_says() -> None:
    fix, now, _ = driving()
    fix.odometry(0.0, 0.0)
    assert fix.look(now + OLD - 0.01).unsure is None
    assert isinstance(fix.look(now + OLD + 0.01).unsure, PoseOld)


def test_a_deviation_that_poses_tell_counts_and_a_large_one_is_not_believed() -> None:
    fix, now, x = driving()
    before = fix.look(now).motion
    fix.heard(now + PERIOD, x + 0.5 * PERIOD, 0.0, 0.0, VAGUE - 0.1)
    after = fix.look(now + PERIOD)
    assert before is not None and after.motion is not None and after.unsure is None
    assert after.motion.off == pytest.approx(before.off + TOLD * (VAGUE - 0.1), abs=1e-3)
    for deviation in (VAGUE + 0.01, math.inf, math.nan):
        fix, now, x = driving()
        fix.heard(now + PERIOD, x + 0.5 * PERIOD, 0.0, 0.0, deviation)
        unsure = fix.look(now + PERIOD).unsure
        assert isinstance(unsure, PoseSettles | PoseVague) and unsure.find(PoseVague) is not None
        assert drive(fix, now + PERIOD, SETTLED + 0.3, x + 0.5 * PERIOD)[2] is None


def rtk(status: int, seconds: float, silent: float = 0.0) -> Reason | None:
    """What is wrong after 8 s with a fix, and some with another status, or without word of it."""
    fix, x = Fix(0.4, rtk=True), 0.0
    fix.odometry(0.5, 0.0)
    now, ends = 0.0, 8.0 + seconds + silent
    while now < ends:
        now, x = now + PERIOD, x + 0.5 * PERIOD
        fix.heard(now, x, 0.0, 0.0)
        if now < 8.0 + seconds:
            fix.fixed(now, RTK if now < 8.0 else status)
        fix.look(now)
    return fix.look(now).unsure


def test_without_an_rtk_fix_no_pose_is_believed_where_one_is_asked_for() -> None:
    assert rtk(RTK, 1.0) is None
    for status in (-1, 0, 1):
        lost = rtk(status, 0.5)
        assert lost is not None and lost.find(FixLost) is not None
    silent = rtk(RTK, 0.0, FIX_OLD + 0.2)
    assert silent is not None and silent.find(FixOld) is not None
    assert rtk(RTK, 0.0, FIX_OLD - 0.2) is None
    unheard = Fix(0.4, rtk=True)
    assert drive(unheard, 0.0, 8.0)[2] == FixOld()
