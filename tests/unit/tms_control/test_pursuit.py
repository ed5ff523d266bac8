"""The regulation of the pure pursuit, and turns on the spot, step by step."""

import math

import pytest

from driven_tracks import GAINS, model
from tms_config.models import DRIVE
from tms_control.path import Path, Piece, Pose
from tms_control.planner import RADIUS
from tms_control.pursuit import Deviation, Pursuit
from tms_control.track_estimate import ZERO, TrackEstimate, TrackState
from tms_control.track_servo import TrackServo

LINE = Piece(Pose(0, 0, 0), 20.0, 0.0)
ARC = Piece(LINE.end, 6.0, 6.0 / RADIUS)


def on(*pieces: Piece, gain: float = 1.0) -> Pursuit:
    estimate, found = TrackEstimate(model("zx200").response[DRIVE]), model("zx200").drive
    assert found is not None
    estimate.yaw_gain = gain
    return Pursuit(Path(pieces), found, TrackServo(found, estimate))


def speed(pursuit: Pursuit, way: Pose, v: float) -> float:
    """Whether it speeds up from a speed [m/s], in m/s of the command beyond it."""
    pursuit.step(TrackState(way, v))
    return pursuit.step(TrackState(way, v)).v - v


@pytest.mark.parametrize(("left", "fastest"), [(10.0, 1.0), (1.75, 0.5), (0.5, 0.25)])
def test_it_slows_down_towards_the_end(left: float, fastest: float) -> None:
    here = Pose(20.0 - left, 0, 0)
    assert speed(on(LINE), here, fastest - 0.02) > 0.0
    assert speed(on(LINE), here, fastest + 0.02) < 0.0


@pytest.mark.parametrize("gain", GAINS)
def test_it_is_slow_enough_before_a_curve_for_tracks_that_scrub(gain: float) -> None:
    fastest = min(1.0, 0.8 * 0.4 * gain * RADIUS)
    path = (LINE, ARC, Piece(ARC.end, 20.0, 0.0))
    assert speed(on(*path, gain=gain), Pose(20, 0, 0), fastest + 0.02) < 0.0
    assert speed(on(*path, gain=gain), Pose(5, 0, 0), 0.9) > 0.0
    if gain < 0.5:
        assert speed(on(*path, gain=gain), Pose(19, 0, 0), 0.95) < 0.0


def test_it_is_slow_where_it_has_to_steer_much() -> None:
    assert speed(on(LINE, gain=1 / 3), Pose(5, 0.7, 0), 0.8) < 0.0 < speed(on(LINE, gain=1 / 3), Pose(5, 0, 0), 0.8)


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("beside", [0.3, -0.3])
def test_it_steers_back_to_the_path(direction: int, beside: float) -> None:
    pursuit = on(Piece(Pose(0, 0, 0), 20.0, 0.0, direction))
    state = TrackState(Pose(direction * 5.0, beside, 0.0), direction * 0.5)
    pursuit.step(state)
    assert math.copysign(1.0, pursuit.step(state).w) == -direction * math.copysign(1.0, beside)
    assert pursuit.deviation(state) == Deviation(pytest.approx(0.3), 0.0)


@pytest.mark.parametrize("turn", [2.0, -2.0])
def test_a_turn_on_the_spot_keeps_its_place_and_brakes_at_its_end(turn: float) -> None:
    pursuit = on(Piece(Pose(0, 0, 0), 0.0, turn))
    command = pursuit.step(TrackState(Pose(0.1, 0, 0)))
    assert command.w * turn > 0.0 > command.v
    fast = 0.3 if turn > 0 else -0.3
    assert abs(pursuit.step(TrackState(Pose(0, 0, turn * 0.96), 0.0, fast)).w) < 0.1, "it slows down"
    assert pursuit.step(TrackState(Pose(0, 0, turn * 0.995), 0.0, turn * 0.05)) == ZERO
    assert not pursuit.done
    assert pursuit.step(TrackState(Pose(0, 0, turn))) == ZERO
    assert pursuit.done


def test_it_counts_what_is_behind() -> None:
    pursuit = on(LINE, ARC, Piece(ARC.end, 0.0, 1.0))
    assert (pursuit.pieces_done, pursuit.left) == (0, 26.0)
    for x in range(19):
        pursuit.step(TrackState(Pose(x, 0, 0), 0.5))
    assert (pursuit.pieces_done, pursuit.left) == (0, pytest.approx(8.0))
    pursuit.step(TrackState(ARC.at(1.0), 0.5))
    assert (pursuit.pieces_done, pursuit.left) == (1, pytest.approx(5.0))
    for v in (0.5, 0.3, 0.1):
        assert pursuit.step(TrackState(ARC.end, v)) == ZERO
        assert pursuit.pieces_done == 1 or not pursuit.left, "it shall stand first"
    pursuit.step(TrackState(ARC.end))
    assert (pursuit.pieces_done, pursuit.left) == (2, 0.0)


def test_a_limit_slows_lines_and_turns_by_the_same_share() -> None:
    turn = Piece(Pose(0, 0, 0), 0.0, math.pi)
    assert speed(on(LINE), Pose(5, 0, 0), 0.32) > 0.0
    slow, free = on(LINE), on(turn)
    slow._servo.fastest = 0.3
    assert speed(slow, Pose(5, 0, 0), 0.32) < 0.0 < speed(slow, Pose(5, 0, 0), 0.28)
    slow = on(turn)
    slow._servo.fastest = 0.3
    share = 0.3 / slow._drive.velocity
    assert slow._servo.fastest_turn == pytest.approx(share * free._servo.fastest_turn)
    r = slow._servo.fastest_turn
    assert slow.step(TrackState(Pose(0, 0, 0), 0.0, r)).w < r  # it is as fast as it may be
