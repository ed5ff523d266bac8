"""Plans begin and end where they shall, and take the shortest time."""

import math
from itertools import pairwise, product

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tms_control.path import SAME_HEADING, Piece, Pose
from tms_control.planner import RADIUS, REVERSE, STOP, Goal, Pace, fastest, plan

PACE = Pace(forward=1.0, turn=0.24)
place = st.floats(-20, 20)
heading = st.floats(-math.pi, math.pi)
poses = st.builds(Pose, place, place, heading)
passed = st.builds(Goal, place, place, st.one_of(st.none(), heading))


def same(a: Pose, b: Pose) -> bool:
    return a.away(b) < 0.01 and abs(a.off(b.yaw)) < 0.01


@given(poses, st.lists(passed, max_size=3), poses, st.sampled_from([0.0, -0.5]))
def test_a_plan_begins_and_ends_as_asked_and_has_no_gaps(
    start: Pose, through: list[Goal], end: Pose, pivot: float
) -> None:
    goals = [*through, Goal(*end)]
    found = plan(start, goals, PACE, pivot)
    pieces = found.path.pieces
    assert same(pieces[0].start.ahead(-pivot), start)
    assert same(pieces[-1].end.ahead(-pivot), end)
    assert all(same(a.end, b.start) for a, b in pairwise(pieces))
    for goal, count in zip(goals, found.reached, strict=True):
        pose = pieces[count - 1].end.ahead(-pivot) if count else start
        assert pose.away(Pose(goal.x, goal.y, 0.0)) < 0.01
        assert goal.yaw is None or abs(pose.off(goal.yaw)) < 0.01


@given(poses, poses)
def test_no_arc_is_tighter_than_allowed(start: Pose, end: Pose) -> None:
    assert all(abs(piece.curvature) <= 1 / RADIUS + 1e-9 for piece in fastest(start, end, PACE))


@given(poses, poses, st.floats(-50, 50), st.floats(-50, 50), heading)
@example(Pose(0, 0, 0), Pose(0, 0, SAME_HEADING), 0.0, 0.0, 0.5)
@example(Pose(0, 0, 0), Pose(10, 0, SAME_HEADING), 1.0, 3.0, 0.5)
def test_where_it_lies_does_not_change_a_plan(start: Pose, end: Pose, x: float, y: float, yaw: float) -> None:
    def moved(pose: Pose) -> Pose:
        c, s = math.cos(yaw), math.sin(yaw)
        return Pose(x + c * pose.x - s * pose.y, y + s * pose.x + c * pose.y, pose.yaw + yaw)

    there = PACE.total(fastest(moved(start), moved(end), PACE))
    here = (PACE.total(fastest(one, other, PACE)) for one, other in product(_beside(start), _beside(end)))
    assert any(total == pytest.approx(there, abs=0.02) for total in here)


def _beside(pose: Pose) -> list[Pose]:
    """A pose, and some so near that only a piece at the very edge of what is left out is there or not."""
    return [Pose(pose.x * (1 + e), pose.y * (1 + e), pose.yaw + e) for e in (0.0, 1e-7, -1e-7)]


@pytest.mark.parametrize(
    ("end", "kinds"),
    [
        (Pose(10, 0, 0), ["ahead"]),
        (Pose(-3, 0, 0), ["back"]),
        (Pose(-60, 0, 0), ["ahead", "ahead", "ahead"]),
        (Pose(0, 0, 2.5), ["turn"]),
        (Pose(20, RADIUS, math.pi / 2), ["ahead", "ahead"]),
        (Pose(0, 2, 0), ["turn", "ahead", "turn"]),
        (Pose(0, 0, 0), []),
    ],
)
def test_what_is_fastest(end: Pose, kinds: list[str]) -> None:
    pieces = fastest(Pose(0, 0, 0), end, PACE)
    assert [("ahead" if one.direction > 0 else "back") if one.length else "turn" for one in pieces] == kinds


def test_poses_that_are_only_passed_are_no_reason_to_stand() -> None:
    found = plan(Pose(0, 0, 0), [Goal(10, 0, None), Goal(20, 5, None), Goal(30, 5, 0.0)], PACE)
    assert all(piece.length for piece in found.path.pieces)
    assert len(found.path.parts()) == 1


def test_poses_behind_are_passed_in_reverse() -> None:
    pieces = plan(Pose(0, 0, 0), [Goal(-2, 0, None), Goal(-4, 0, 0)], PACE).path.pieces
    assert [piece.direction for piece in pieces] == [-1, -1]


def test_a_change_of_direction_costs_a_stop() -> None:
    ahead, back = Piece(Pose(0, 0, 0), 2.0, 0.0), Piece(Pose(2, 0, 0), 2.0, 0.0, -1)
    assert PACE.total([ahead, back]) == pytest.approx(2.0 + STOP + 2.0 / REVERSE)


def test_a_machine_whose_yaw_rate_is_low_turns_less() -> None:
    end, slow = Pose(-12, 0, 0), Pace(1.0, 0.4 / 3)
    assert fastest(Pose(0, 0, 0), end, slow)[0].direction == -1
    assert PACE.total(fastest(Pose(0, 0, 0), Pose(10, 0, 3.1), PACE)) < slow.total(
        fastest(Pose(0, 0, 0), Pose(10, 0, 3.1), slow)
    )
