"""The control law for a joint that answers its commands late and sluggishly. Pure logic, any clock.

A drive brings its joint to the angle u that it was sent, dq/dt = (u(t - D) - q) / tau: after a dead time D, as a
first-order lag tau. A command takes effect a dead time later. So the law predicts where the joint is then, from
the last measurement through the commands that are under way, and sends the angle at which the lag gives the velocity of
the reference and takes back what is missing.
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

    def __init__(self, dead_time: float, lag: float, velocity: float) -> None:
        """`dead_time` and `lag` [s] as far as they are known; `velocity` is the joint's limit [rad/s]."""
        self.dead_time, self.lag = dead_time, lag
        self._most = MARGIN * velocity
        self._sent: deque[tuple[float, float]] = deque()  # s, rad: the command in effect, and those under way

    def command(self, now: float, measured: float, position: float, velocity: float) -> float:
        """Angle to send now [rad], for a joint that should be at `position` with `velocity` a dead time from now."""
        predicted = self.predicted(now, measured)
        wanted = velocity + GAIN * (position - predicted)
        sent = predicted + self.lag * max(-self._most, min(self._most, wanted))
        self._sent.append((now, sent))
        return sent

    def predicted(self, now: float, measured: float) -> float:
        """Where the joint will be [rad] when all commands so far have taken effect."""
        self._forget(now - self.dead_time)
        if not self._sent:
            return measured
        since = now - self.dead_time
        for (begun, angle), (end, _) in pairwise([*self._sent, (now, 0.0)]):
            seconds = end - max(begun, since)
            measured = angle + (measured - angle) * math.exp(-seconds / self.lag)
        return measured

    def predicted_velocity(self, now: float, measured: float) -> float:
        """The velocity of the joint then [rad/s]."""
        return (self._sent[-1][1] - self.predicted(now, measured)) / self.lag if self._sent else 0.0

    def rest(self) -> None:
        """Forget all commands: the joint stands, and none is under way."""
        self._sent.clear()

    def _forget(self, time: float) -> None:
        """Forget the commands before the one that is in effect at `time`."""
        while len(self._sent) > 1 and self._sent[1][0] <= time:
            self._sent.popleft()
