"""Brings tracks to a speed and a yaw rate: the inverse of their lag, within their limits. Pure logic."""

import math

from tms_config.models import Drive
from tms_control.track_estimate import BRAKES, ZERO, Command, TrackEstimate, TrackState

SETTLES = 0.4  # s, time constant with which speeds come to what is wanted: well above the delay of poses and commands
SLOW = 0.05  # m/s, rad/s, from which a machine that shall stand may brake hard


class TrackServo:
    """Turns wanted speeds into commands."""

    def __init__(self, drive: Drive, estimate: TrackEstimate) -> None:
        self._drive, self._estimate = drive, estimate
        self.fastest = drive.velocity  # m/s, as far as somebody limits it

    @property
    def fastest_turn(self) -> float:
        """Yaw rate that the tracks can reach [rad/s]; a limit of the speed slows it by the same share."""
        share = min(self.fastest / self._drive.velocity, 1.0)
        return self._drive.turn_velocity * min(self._estimate.yaw_gain, 1.0) * share

    def lead(self, state: TrackState, v: float, r: float) -> Command:
        """The command for a wanted speed [m/s] and yaw rate [rad/s], both reached with limited acceleration."""
        drive, known = self._drive, self._estimate
        ahead = state.v + known.lag * _within((v - state.v) / SETTLES, drive.acceleration)
        round_ = state.r + known.lag * _within((r - state.r) / SETTLES, drive.turn_acceleration)
        forward = _within(ahead - known.trim, drive.velocity)
        turn = _within((round_ - known.turn_trim) / known.yaw_gain, drive.turn_velocity)
        if Command(forward, turn).brakes:
            forward = math.copysign(2 * BRAKES, forward)  # slow down without the brakes
        return Command(forward, turn)

    def slow_down(self, state: TrackState) -> Command:
        """The command to stand soon: a ramp, then the brakes."""
        if abs(state.v) < SLOW and abs(state.r) < SLOW:
            return ZERO
        return self.lead(state, 0.0, 0.0)


def _within(value: float, most: float) -> float:
    return max(-most, min(most, value))
