"""Pieces of paths, and paths that somebody else has planned."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_control.path import Path, Piece, Pose, Run, told

place = st.floats(-20, 20)
heading = st.floats(-math.pi, math.pi)
poses = st.builds(Pose, place, place, heading)


@given(poses, st.floats(0.1, 20), st.floats(-6, 6), st.sampled_from([1, -1]))
def test_a_piece_goes_where_its_heading_points(start: Pose, length: float, turn: float, direction: int) -> None:
    piece, x, y, count = Piece(start, length, turn, direction), start.x, start.y, 300
    for i in range(count):
        yaw = start.yaw + turn * (i + 0.5) / count
        x += direction * length / count * math.cos(yaw)
        y += direction * length / count * math.sin(yaw)
    assert piece.end == pytest.approx((x, y, start.yaw + turn), abs=2e-3)


@given(poses, st.floats(0.5, 20), st.floats(-1.5, 1.5), st.sampled_from([1, -1]), st.floats(0, 1), st.floats(-0.3, 0.3))
def test_a_place_beside_a_run_is_found_again(
    start: Pose, length: float, turn: float, direction: int, share: float, beside: float
) -> None:
    run = Run((Piece(start, length, turn, direction),))
    x, y, yaw = run.at(share * length)
    if abs(run.pieces[0].curvature * beside) < 0.3:
        found = run.project(Pose(x - beside * math.sin(yaw), y + beside * math.cos(yaw), yaw), share * length)
        assert found == pytest.approx(share * length, abs=0.02)


def test_beyond_its_end_a_run_goes_straight_on() -> None:
    run = Run((Piece(Pose(0, 0, 0), 2.0, 0.0, -1), Piece(Pose(-2, 0, 0), math.pi, math.pi / 2, -1)))
    assert run.at(run.length) == pytest.approx((-4, -2, math.pi / 2))
    assert run.at(run.length + 3) == pytest.approx((-4, -5, math.pi / 2))
    assert run.project(Pose(-4.1, -4, 0), run.length) == pytest.approx(run.length + 2)


def test_pieces_in_one_direction_are_driven_without_a_stop() -> None:
    ahead, on = Piece(Pose(0, 0, 0), 2.0, 0.0), Piece(Pose(2, 0, 0), 2.0, 1.0)
    turn = Piece(on.end, 0.0, 1.0)
    back = Piece(turn.end, 1.0, 0.0, -1)
    assert Path((ahead, on, turn, back)).parts() == (Run((ahead, on)), turn, Run((back,)))


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("turn", [0.0, 1.2, -4.0])
def test_a_told_path_is_the_one_that_was_planned(direction: int, turn: float) -> None:
    planned = Path(
        (
            Piece(Pose(1, 2, 0.5), 3.0, 0.0, direction),
            Piece(Piece(Pose(1, 2, 0.5), 3.0, 0.0, direction).end, 8.0, turn, direction),
        )
    )
    heard = told(list(planned.poses(0.2)))
    assert {piece.direction for piece in heard.pieces} == {direction}
    assert heard.length == pytest.approx(planned.length, rel=1e-6)
    assert heard.end[:2] == pytest.approx(planned.end[:2])
    assert sum(piece.turn for piece in heard.pieces) == pytest.approx(turn)


def test_headings_that_say_nothing_are_not_followed() -> None:
    heard = told([Pose(0, 0, 0), Pose(0, 1, 0), Pose(0, 2, 0), Pose(0, 3, 1.0)])
    turn, *lines, last = heard.pieces
    assert turn == Piece(Pose(0, 0, 0), 0.0, pytest.approx(math.pi / 2))
    assert [piece.start.yaw for piece in lines] == pytest.approx([math.pi / 2] * 3)
    assert last.length == 0.0 and last.end == pytest.approx((0, 3, 1.0))


def test_a_told_path_of_one_pose_is_a_turn() -> None:
    assert told([Pose(1, 2, 3)]).pieces == (Piece(Pose(1, 2, 3), 0.0, 0.0),)
