"""Tracks come to the speeds that are wanted, softly, whatever they do beyond their commands."""

import math
from itertools import pairwise

import pytest

from tms_config.models import Drive, Response
from tms_control.path import Pose
from tms_control.track_estimate import ZERO, Command, PoseSample, TrackEstimate, TrackState
from tms_control.track_servo import TrackServo

DRIVE = Drive(velocity=1.0, acceleration=0.5, turn_velocity=0.4, turn_acceleration=0.4)
LAG, STEP = 0.6, 0.05  # s


class Tracks:
    """Tracks with a yaw gain, which go and turn beyond their commands."""

    def __init__(self, gain: float = 1.0, more: float = 0.0, more_turn: float = 0.0) -> None:
        self.estimate = TrackEstimate(Response(dead_time=0.0, lag=LAG, origin="a test"))
        self.servo = TrackServo(DRIVE, self.estimate)
        self.now, self.pose, self.v, self.r = 0.0, Pose(0, 0, 0), 0.0, 0.0
        self._gain, self._more = gain, Command(more, more_turn)

    def go(self, v: float, r: float, seconds: float) -> list[tuple[float, float]]:
        """Speeds on the way."""
        found = []
        for _ in range(round(seconds / STEP)):
            self.estimate.measured(PoseSample(self.now, self.pose))
            command = self.servo.lead(self.estimate.at(self.now), v, r)
            self.estimate.sent(self.now, command)
            for _ in range(5):
                self._move(command, STEP / 5)
            self.now += STEP
            found.append((self.v, self.r))
        return found

    def _move(self, command: Command, h: float) -> None:
        share = -math.expm1(-h / LAG)
        self.v += share * (command.v + self._more.v - self.v)
        self.r += share * (self._gain * command.w + self._more.w - self.r)
        self.pose = self.pose._replace(yaw=self.pose.yaw + self.r * h).ahead(self.v * h)


@pytest.mark.parametrize("gain", [1 / 3, 0.6, 1.0])
@pytest.mark.parametrize(("v", "r"), [(0.5, 0.05), (-0.3, 0.1), (0.0, -0.1)])
def test_speeds_are_reached_in_spite_of_what_nobody_has_commanded(gain: float, v: float, r: float) -> None:
    tracks = Tracks(gain, more=0.1, more_turn=-0.03)
    tracks.go(v, r, 15.0)
    assert (tracks.v, tracks.r) == pytest.approx((v, r), abs=0.01)


def test_a_track_that_drags_does_not_turn_a_machine_that_goes_straight() -> None:
    tracks = Tracks(0.6, more_turn=0.1)
    tracks.go(0.5, 0.0, 15.0)
    assert tracks.r == pytest.approx(0.0, abs=0.005)


def test_acceleration_is_limited() -> None:
    tracks = Tracks(0.6)  # what is thought at first
    speeds = tracks.go(0.9, 0.0, 1.0)
    assert max(b[0] - a[0] for a, b in pairwise(speeds)) <= 1.1 * DRIVE.acceleration * STEP
    tracks.go(0.0, 0.2, 3.0)
    turns = tracks.go(0.0, -0.2, 0.3)
    assert max(a[1] - b[1] for a, b in pairwise(turns)) <= 1.1 * DRIVE.turn_acceleration * STEP


def test_limits_of_commands_hold() -> None:
    command = Tracks(0.3).servo.lead(TrackState(Pose(0, 0, 0), 0.9, 0.3), 3.0, 2.0)
    assert command == Command(DRIVE.velocity, DRIVE.turn_velocity)


def test_slowing_down_does_not_brake_until_it_is_slow() -> None:
    servo = Tracks().servo
    assert not servo.slow_down(TrackState(Pose(0, 0, 0), LAG * DRIVE.acceleration)).brakes  # the ramp passes 0 here
    assert servo.slow_down(TrackState(Pose(0, 0, 0), 0.04, 0.02)) == ZERO
    assert servo.slow_down(TrackState(Pose(0, 0, 0), 0.0, 0.2)) != ZERO
