"""Where a machine is by its localisation, how it moves, and whether that can be believed.

Poses that are old, or that jump further than the machine can go, are not; nor those that stand to the last bit while
its odometry moves, those that say themselves that they are `VAGUE`, nor any while a GNSS that the site names has no
RTK fix. Afterwards it takes `SETTLED` seconds of good ones.
"""

import math
from collections import deque
from dataclasses import dataclass, field, replace

import numpy as np

from tms_areas.reasons import FixLost, FixOld, PoseJumped, PoseOld, PoseSettles, PoseStuck, PoseUnknown, PoseVague
from tms_reason.reason import Reason

WINDOW = 0.5  # s of poses whose line gives place and speed
LEAST = 4  # poses in it
OLD = 0.5  # s without a pose after which tracks stop ...
RESTING = 2.0  # s, ... and while the odometry stands: many tell a place less often then
RESTS = 0.1  # m/s or rad/s; where poses say less, and the odometry stands, the machine stands
SETTLED = 5.0  # s of good poses after which they may go on
SURE = 0.1  # m that a pose may be off without showing it
NOISE = 3.0  # times the deviation from that line that a pose may be off in addition
MOVES = 0.05  # m/s or rad/s of the odometry at which a pose that is the same to the last bit is no news
LEAP, LEAP_NOISE = 0.1, 4.0  # m, and times the deviation, that a pose may be off where the motion leads
LEAP_TURN = 0.1  # rad that its heading may be off
TOLD = 3.0  # times the deviation that a pose tells of itself that it may be off
VAGUE = 0.3  # m; a pose that tells a larger deviation is not believed
RTK = 2  # status of NavSatFix with an RTK fix (STATUS_GBAS_FIX)
FIX_OLD = 1.0  # s without word of the fix: receivers tell it 5 to 20 times a second
SPEED_UP = 0.2  # m/s by which a machine may be faster than its last poses say


@dataclass(frozen=True)
class Motion:
    """Where the base is in `map`, and how it moves."""

    x: float  # m
    y: float  # m
    yaw: float  # rad
    vx: float = 0.0  # m/s
    vy: float = 0.0  # m/s
    turning: float = 0.0  # rad/s
    off: float = SURE  # m that the place may be off
    age: float = 0.0  # s since it arrived; 0 for a machine that stands

    @property
    def rests(self) -> bool:
        """Whether it stands."""
        return self.vx == self.vy == self.turning == 0.0


@dataclass(frozen=True)
class Seen:
    """One look at a place."""

    unsure: Reason | None  # why it is not believed
    motion: Motion | None  # by the last pose that was believed


@dataclass
class Fix:
    """What is known from the poses so far. Times are of one monotonic clock [s]."""

    turn_top: float  # rad/s, of the machine
    rtk: bool = False  # whether a GNSS has to tell of an RTK fix
    poses: deque[tuple[float, float, float, float]] = field(default_factory=deque)  # when, x, y, yaw (unwrapped)
    deviation: float = 0.0  # m, that the last pose tells
    fix_at: float = float("-inf")  # when word of the fix came
    wrong: Reason | None = field(default_factory=PoseUnknown)
    wrong_at: float = float("-inf")  # when it was last wrong
    repeated_at: float = float("-inf")  # when a pose last was no news
    moves: bool = False  # by the odometry
    motion: Motion | None = None  # by the last pose that was believed ...
    motion_at: float = 0.0  # ... and when that came

    def heard(self, at: float, x: float, y: float, yaw: float, deviation: float = 0.0) -> None:
        """Take a pose that arrived at a time; `deviation` [m] as it tells itself, 0: it does not."""
        if not all(map(math.isfinite, (x, y, yaw))):
            return self._doubt(PoseUnknown(), at)
        if not deviation <= VAGUE:
            self._doubt(PoseVague(deviation, VAGUE), at)
        self.deviation = deviation
        if self.poses:
            when, _, _, before = self.poses[-1]
            if at <= when:
                return None
            yaw = before + math.remainder(yaw - before, math.tau)
            if at - when > self._limit:
                self._doubt(PoseOld(at - when), at)
            if self._leaps(at, x, y, yaw):
                self.poses.clear()
                self._doubt(PoseJumped(), at)
        if self.poses and self.poses[-1][1:] == (x, y, yaw) and self.moves:
            self.repeated_at = at
            return None
        self.poses.append((at, x, y, yaw))
        while len(self.poses) > LEAST and self.poses[0][0] < at - WINDOW:
            self.poses.popleft()
        if self.wrong is None and len(self.poses) >= LEAST:
            self.motion, self.motion_at = self._line(), at
        return None

    def fixed(self, at: float, status: int) -> None:
        """Take the status of the GNSS, as NavSatFix numbers it, that arrived at a time."""
        self.fix_at = at
        if status != RTK:
            self._doubt(FixLost(), at)

    def odometry(self, forward: float, turning: float) -> None:
        """Take what the tracks say of their own speed [m/s, rad/s]."""
        self.moves = abs(forward) > MOVES or abs(turning) > MOVES

    def look(self, now: float) -> Seen:
        """What is known now."""
        unsure = self._unsure(now)
        one = self.motion
        if one is None or (unsure is None and not self.moves and one.rests):
            return Seen(unsure, one)
        return Seen(unsure, replace(one, age=now - self.motion_at))

    def _unsure(self, now: float) -> Reason | None:
        age = now - self.poses[-1][0] if self.poses else float("inf")
        if age > self._limit:
            unknown = PoseOld(age) if self.poses else PoseUnknown()
            self._doubt(PoseStuck() if now - self.repeated_at <= OLD else unknown, now)
        if self.rtk and now - self.fix_at > FIX_OLD:
            self._doubt(FixOld(), now)
        if self.wrong is not None:
            left = self.wrong_at + SETTLED - now
            if left > 0 or len(self.poses) < LEAST:
                return PoseSettles(self.wrong, max(left, 0.0)) if left < SETTLED else self.wrong
            self.wrong, self.motion, self.motion_at = None, self._line(), self.poses[-1][0]
        return None

    @property
    def _limit(self) -> float:
        """How old a pose may be: with two words for it that the machine stands, older than with one."""
        rests = not self.moves and (self.motion is None or self.motion.rests)
        return RESTING if rests else OLD

    def _doubt(self, why: Reason, at: float) -> None:
        self.wrong, self.wrong_at = why, at

    def _leaps(self, at: float, x: float, y: float, yaw: float) -> bool:
        """Whether no motion of the machine leads to a pose."""
        when, bx, by, byaw = self.poses[-1]
        passed, speed, noise = at - when, 0.0, 0.0
        if (one := self.motion) is not None:
            speed, noise = math.hypot(one.vx, one.vy), (one.off - SURE) / NOISE
        way = LEAP + LEAP_NOISE * noise + 1.2 * (speed + SPEED_UP) * passed
        return math.hypot(x - bx, y - by) > way or abs(yaw - byaw) > LEAP_TURN + 1.2 * self.turn_top * passed

    def _line(self) -> Motion:
        """The straight line through the poses of the window, at its end (least squares)."""
        found = np.array(self.poses)
        t = found[:, 0] - found[-1, 0]
        at = np.column_stack([np.ones_like(t), t])
        line, *_ = np.linalg.lstsq(at, found[:, 1:], rcond=None)
        rest = found[:, 1:3] - (at @ line)[:, :2]
        off = SURE + NOISE * float(np.sqrt((rest**2).sum() / len(t))) + TOLD * self.deviation
        (x, y, yaw), (vx, vy, turning) = line.tolist()
        if not self.moves and max(math.hypot(vx, vy), abs(turning)) < RESTS:
            vx = vy = turning = 0.0
        return Motion(x, y, yaw, vx, vy, turning, off)
