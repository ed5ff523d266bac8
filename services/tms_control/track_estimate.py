"""Where a machine with tracks is now, how fast it moves, and how its tracks answer. Pure logic.

Poses come seldom and late. In between, a model moves by the commands that were sent: a dead time, then a first-order
lag for speed and yaw rate. With each pose the model is corrected, and three things are learned:

- the yaw gain: tracks scrub when they turn, so that the yaw rate is an unknown part of the one commanded, 1/3 to 1 in
  OperaSim-PhysX. It is fitted by least squares to the turns measured and those that a gain of 1 would have made.
- the pivot: the place of the machine that stays where it is in a turn on the spot. In OperaSim-PhysX the middle wheels
  hold it, and those of ic120 are half a metre behind the place whose pose is told.
- trims: what the tracks do beyond a command, for instance by an integral part in the drive that outlives a stop.
  They are the integral of what the model was off.
"""

import math
from bisect import bisect_right
from dataclasses import dataclass, replace
from typing import NamedTuple

from tms_config.models import Response
from tms_control.path import Pose

SUBSTEP = 0.02  # s
BRAKE = 0.1  # s, lag of the brakes, far shorter than that of any drive; a simulator's hold almost at once
BRAKES = 1e-3  # m/s, rad/s: smaller commands brake
GAP = 0.5  # s between poses, after which nothing is learned from the way in between
BELIEF = 0.2  # s, time constant with which measured speeds are believed more than those of the model
TRIM_TIME = 1.5  # s, time constant of the trims
MOST_TRIM, MOST_TURN_TRIM = 0.3, 0.15  # m/s, rad/s
FIRST_GAIN, LEAST_GAIN, MOST_GAIN = 0.6, 0.25, 1.25
FIRST_WEIGHT = 2e-4  # rad2, what the first gain counts: two poses of a turn outweigh it
FORGETS = 1.0  # rad of commanded turn, after which a measured one counts 1/e
PIVOT_WEIGHT = 2e-3  # rad2, what a pivot at 0 counts at first
MOST_PIVOT = 1.0  # m
KICK, KICK_TURN = 0.25, 0.1  # m, rad off the model in one step: something else than the tracks has moved it


class Command(NamedTuple):
    """A Twist, as far as tracks follow one."""

    v: float  # m/s
    w: float  # rad/s

    @property
    def brakes(self) -> bool:
        """Whether tracks that get it brake."""
        return abs(self.v) < BRAKES and abs(self.w) < BRAKES


ZERO = Command(0.0, 0.0)


class PoseSample(NamedTuple):
    """A measured pose."""

    time: float  # s of the machine's clock, when it was measured
    pose: Pose


@dataclass(frozen=True)
class TrackState:
    """Pose and motion at one time."""

    pose: Pose
    v: float = 0.0  # m/s
    r: float = 0.0  # rad/s, yaw rate
    full: float = 0.0  # rad/s, yaw rate that a gain of 1 would give

    @property
    def stands(self) -> bool:
        """Whether it stands, as far as poses that jitter by some millimetres can tell."""
        return abs(self.v) < 0.05 and abs(self.r) < 0.03


class TrackEstimate:
    """Kept for as long as the machine's clock goes on, whose seconds all times are. It may pause, not be set back."""

    def __init__(self, response: Response) -> None:
        self.lag = response.lag
        self.yaw_gain = FIRST_GAIN
        self.trim, self.turn_trim = 0.0, 0.0  # m/s, rad/s: count like commands
        self._dead_time = response.dead_time
        self._last: PoseSample | None = None
        self._state = TrackState(Pose(0.0, 0.0, 0.0))  # at the last pose
        self._times: list[float] = []  # s, when commands take effect
        self._commands: list[Command] = []
        self.pivot = 0.0  # m ahead of the place whose pose is told
        self._sides, self._turns = 0.0, PIVOT_WEIGHT  # m rad, rad2, of the fit of the pivot
        self._products, self._squares = FIRST_WEIGHT * FIRST_GAIN, FIRST_WEIGHT  # rad2, of the fit of the gain

    def age(self, now: float) -> float:
        """How old the last pose is [s]; infinite without one, and a pose of the future is as bad as an old one."""
        return math.inf if self._last is None else abs(now - self._last.time)

    def sent(self, now: float, command: Command) -> None:
        """Take a command that the machine gets now; it counts until the next one."""
        self._times.append(max([now + self._dead_time, *self._times[-1:]]))
        self._commands.append(command)

    def measured(self, sample: PoseSample) -> None:
        """Take a pose; one that is not newer than the last says nothing."""
        last = self._last
        if last is not None and sample.time <= last.time:
            return
        if last is None or sample.time - last.time > GAP:
            self._state = TrackState(sample.pose)
        else:
            model, turned = self._moved(self._state, last.time, sample.time)
            self._learn(model, turned, sample, sample.time - last.time)
        self._last = sample
        keep = max(bisect_right(self._times, sample.time) - 1, 0)
        del self._times[:keep], self._commands[:keep]

    def at(self, now: float) -> TrackState:
        """Where it is and how it moves when a command of now takes effect, by the last pose and the commands since."""
        if self._last is None:
            return self._state
        return self._moved(self._state, self._last.time, now + self._dead_time)[0]

    def _learn(self, model: TrackState, full_turn: float, sample: PoseSample, seconds: float) -> None:
        before, turn = self._state.pose, model.pose.off(sample.pose.yaw)
        self._state = replace(model, pose=sample.pose)
        if model.pose.away(sample.pose) > KICK or abs(turn) > KICK_TURN:
            return
        belief = -math.expm1(-seconds / BELIEF)
        v_off, r_off = belief * model.pose.seen(sample.pose)[0] / seconds, belief * turn / seconds
        self._state = replace(self._state, v=model.v + v_off, r=model.r + r_off)
        if self._in_effect(sample.time).brakes:
            return
        share = self.lag / TRIM_TIME
        self.trim = _within(self.trim + share * v_off, MOST_TRIM)
        self.turn_trim = _within(self.turn_trim + share * r_off, MOST_TURN_TRIM)
        self._learn_gain(full_turn, before.off(sample.pose.yaw))
        self._learn_pivot(before, sample.pose)

    def _learn_gain(self, full_turn: float, turn: float) -> None:
        kept = math.exp(-abs(full_turn) / FORGETS)
        self._products = kept * self._products + full_turn * turn
        self._squares = kept * self._squares + full_turn**2
        self.yaw_gain = min(max(self._products / self._squares, LEAST_GAIN), MOST_GAIN)

    def _learn_pivot(self, before: Pose, after: Pose) -> None:
        """A turn moves what is ahead of the pivot to the side."""
        turn = before.off(after.yaw)
        side = before._replace(yaw=before.yaw + turn / 2).seen(after)[1]
        kept = math.exp(-abs(turn) / FORGETS)
        self._sides = kept * self._sides - turn * side
        self._turns = kept * self._turns + turn**2
        self.pivot = _within(self._sides / self._turns, MOST_PIVOT)

    def _in_effect(self, time: float) -> Command:
        number = bisect_right(self._times, time)
        return self._commands[number - 1] if number else ZERO

    def _moved(self, state: TrackState, begin: float, end: float) -> tuple[TrackState, float]:
        """The state after a while, and the turn that a gain of 1 would have made [rad].

        Plain numbers inside: it makes up most of what the control of tracks costs.
        """
        (x, y, yaw), v, r, full = state.pose, state.v, state.r, state.full
        full_turn, time = 0.0, begin
        while end - time > 1e-9:
            seconds = min(SUBSTEP, end - time)
            lag, new_v, new_r, new_full = self._answer(self._in_effect(time))
            kept = math.exp(-seconds / lag)
            v, r, full = new_v + (v - new_v) * kept, new_r + (r - new_r) * kept, new_full + (full - new_full) * kept
            middle, way = yaw + r * seconds / 2, v * seconds
            x, y, yaw = x + way * math.cos(middle), y + way * math.sin(middle), yaw + r * seconds
            full_turn += full * seconds
            time += seconds
        return TrackState(Pose(x, y, yaw), v, r, full), full_turn

    def _answer(self, command: Command) -> tuple[float, float, float, float]:
        """Lag [s] of the tracks under a command, and what they come to: speed, yaw rate, yaw rate with a gain of 1."""
        if command.brakes:
            return BRAKE, 0.0, 0.0, 0.0
        return self.lag, command.v + self.trim, self.yaw_gain * command.w + self.turn_trim, command.w


def _within(value: float, most: float) -> float:
    return max(-most, min(most, value))
