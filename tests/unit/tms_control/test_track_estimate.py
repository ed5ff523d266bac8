"""What is known of tracks between two poses, and what is learned of them."""

import math

import pytest

from driven_tracks import GAINS, MODELS, DrivenTracks
from tms_config.models import Response
from tms_control.path import Pose
from tms_control.track_estimate import ZERO, Command, PoseSample, TrackEstimate, TrackState
from tms_control.trip_task import Task

RESPONSE = Response(dead_time=0.0, lag=1.0, origin="a test")


@pytest.mark.parametrize("gain", GAINS)
@pytest.mark.parametrize("model", MODELS)
def test_the_yaw_gain_is_known_after_a_quarter_of_a_turn(model: str, gain: float) -> None:
    machine = DrivenTracks(model, gain)
    trip = machine.trip(Task.to(Pose(0, 0, 3.0)))
    machine.run(trip, until=lambda: machine.pose.yaw > 1.5)
    assert machine.estimate.yaw_gain == pytest.approx(gain, rel=0.15)  # integral parts of drives overshoot


@pytest.mark.parametrize("pivot", [-0.5, 0.0, 0.3])
def test_the_pivot_is_known_after_a_quarter_of_a_turn(pivot: float) -> None:
    machine = DrivenTracks("ic120", pivot=pivot)
    trip = machine.trip(Task.to(Pose(0, 0, 3.0)))
    machine.run(trip, until=lambda: machine.pose.yaw > 1.5)
    assert machine.estimate.pivot == pytest.approx(pivot, abs=0.05)


def test_a_kick_teaches_nothing() -> None:
    machine = DrivenTracks("zx200")
    trip = machine.trip(Task.to(Pose(20, 8, 1.5)))
    machine.run(trip, until=lambda: machine.pose.x > 10)
    known = machine.estimate.pivot, machine.estimate.yaw_gain
    machine.kick(0.5, 1.0)
    machine.run(trip, 0.2)
    assert (machine.estimate.pivot, machine.estimate.yaw_gain) == pytest.approx(known, abs=0.02)


@pytest.mark.parametrize("model", MODELS)
def test_where_it_is_between_poses(model: str) -> None:
    machine = DrivenTracks(model)
    trip = machine.trip(Task.to(Pose(20, 12, 1.5)))
    machine.run(trip, 12.0)
    for _ in range(4):
        machine.run(trip, 0.5)
        machine.blind = True
        machine.run(trip, 0.4)
        state = machine.estimate.at(machine.now)
        assert state.pose.away(machine.pose) < 0.08  # m; at 1 m/s
        assert abs(state.pose.off(machine.pose.yaw)) < 0.02
        machine.blind = False


def test_a_command_answers_late_by_dead_time_and_lag() -> None:
    estimate = TrackEstimate(Response(dead_time=0.5, lag=2.0, origin="a test"))
    estimate.measured(PoseSample(0.0, Pose(0, 0, 0)))
    estimate.sent(0.0, Command(1.0, 0.0))
    assert estimate.at(0.0).v == 0.0
    assert estimate.at(2.0).v == pytest.approx(1 - math.exp(-1.0))  # as a command of then will find it
    estimate.sent(2.0, ZERO)
    assert estimate.at(2.5).v == pytest.approx(0.0, abs=0.01)


def test_what_the_tracks_do_beyond_a_command_is_learned() -> None:
    estimate, x, now = TrackEstimate(RESPONSE), 0.0, 0.0
    for _ in range(100):
        estimate.measured(PoseSample(now, Pose(x, 0, 0)))
        estimate.sent(now, Command(0.1, 0.0))
        x, now = x + 0.06 * 0.2, now + 0.06  # twice as fast as told
    assert estimate.trim == pytest.approx(0.1, abs=0.01)
    assert estimate.at(now).v == pytest.approx(0.2, abs=0.01)


def test_jitter_while_it_brakes_teaches_nothing() -> None:
    estimate, known = TrackEstimate(RESPONSE), TrackEstimate(RESPONSE).yaw_gain
    for i in range(100):
        estimate.sent(0.06 * i, ZERO)
        estimate.measured(PoseSample(0.06 * i, Pose(0.004 * (i % 3), 0, 0.004 * (i % 2))))
    assert (estimate.trim, estimate.turn_trim, estimate.yaw_gain) == (0.0, 0.0, pytest.approx(known))


def test_after_a_pause_nothing_is_concluded_from_it() -> None:
    estimate = TrackEstimate(RESPONSE)
    estimate.measured(PoseSample(0.0, Pose(0, 0, 0)))
    estimate.sent(0.0, Command(1.0, 0.0))
    estimate.measured(PoseSample(100.0, Pose(2, 0, 0)))
    assert estimate.at(100.0) == TrackState(Pose(2, 0, 0))


def test_poses_that_are_not_newer_say_nothing() -> None:
    estimate = TrackEstimate(RESPONSE)
    assert estimate.age(0.0) == math.inf
    estimate.measured(PoseSample(1.0, Pose(1, 0, 0)))
    estimate.measured(PoseSample(0.9, Pose(0, 0, 0)))
    assert estimate.age(1.2) == pytest.approx(0.2)
    assert estimate.at(1.0).pose == Pose(1, 0, 0)


def test_a_pose_of_the_future_is_no_fresh_one() -> None:
    estimate = TrackEstimate(RESPONSE)
    estimate.measured(PoseSample(100.0, Pose(1, 0, 0)))
    assert estimate.age(3.0) == pytest.approx(97.0)
