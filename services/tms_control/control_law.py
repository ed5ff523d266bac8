"""The control law for a joint that answers its commands late and sluggishly. Pure logic, any clock.

A drive brings its joint to the angle u that it was sent, dq/dt = (u(t - D) - d - q) / tau: after a dead time D, as a
first-order lag tau, and short of it by the droop d, since gravity pulls at the joint. A command takes effect a dead
time later. So the law predicts where the joint is then, from the last measurement through the commands that are under
way, and sends the angle at which the lag gives the velocity of the reference and takes back what is missing.
"""

import math
from collections import deque
from itertools import pairwise

GAIN = 1.0  # 1/s, of the difference between reference and prediction
MARGIN = 1.5  # times its velocity limit: room to catch up at the limit, also with the lag a third wrong


class ControlLaw:
    """Computes the commands with which one joint follows a reference.

    The caller evaluates the reference a dead time ahead. Joints of one motion have different dead times: their common
    clock starts the longest of them after the goal was accepted, and each reference is `dead_time` ahead of this clock.
    """

    def __init__(self, dead_time: float, lag: float, velocity: float, droop: float = 0.0) -> None:
        """`dead_time`, `lag` [s] and `droop` [rad] as far as known; `velocity` is the joint's limit [rad/s]."""
        self.dead_time, self.lag, self.droop = dead_time, lag, droop
        self._most = MARGIN * velocity
        self._sent: deque[tuple[float, float]] = deque()  # s, rad: the command in effect, and those under way

    def command(
        self, now: float, measured: float, position: float, velocity: float, measured_at: float | None = None
    ) -> float:
        """Angle to send now [rad], for a joint that should be at `position` with `velocity` a dead time from now.

        `measured_at`: when the joint was measured, if not now.
        """
        predicted = self.predicted(now, measured, measured_at)
        wanted = velocity + GAIN * (position - predicted)
        sent = predicted + self.droop + self.lag * max(-self._most, min(self._most, wanted))
        self._sent.append((now, sent))
        return sent

    def predicted(self, now: float, measured: float, measured_at: float | None = None) -> float:
        """Where the joint will be [rad] when all commands so far have taken effect."""
        return self.moved(measured, now if measured_at is None else measured_at, now + self.dead_time)

    def moved(self, position: float, begin: float, end: float) -> float:
        """Where the joint is [rad] at `end` if it is at `position` at `begin`; `begin` never goes back."""
        begin, end = begin - self.dead_time, end - self.dead_time
        self._forget(begin)
        for (since, angle), (until, _) in pairwise([*self._sent, (math.inf, 0.0)]):
            seconds = min(until, end) - max(since, begin)
            if seconds > 0.0:
                goal = angle - self.droop
                position = goal + (position - goal) * math.exp(-seconds / self.lag)
        return position

    def predicted_velocity(self, now: float, measured: float, measured_at: float | None = None) -> float:
        """The velocity of the joint then [rad/s]."""
        if not self._sent:
            return 0.0
        return (self._sent[-1][1] - self.droop - self.predicted(now, measured, measured_at)) / self.lag

    def rest(self) -> None:
        """Forget all commands: the joint stands, and none is under way."""
        self._sent.clear()

    def _forget(self, time: float) -> None:
        """Forget the commands before the one that is in effect at `time`."""
        while len(self._sent) > 1 and self._sent[1][0] <= time:
            self._sent.popleft()
