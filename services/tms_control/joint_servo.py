"""One joint under control: which angle to send so that it follows a reference, or comes to stand. Pure logic."""

import math

from tms_config.models import Joint, Response
from tms_control.control_law import ControlLaw
from tms_control.drive_estimate import DriveEstimate, Fit

PERIOD = 0.02  # s over which the velocity of a reference is taken


class JointServo:
    """Positions in rad, velocities in rad/s, times in s of the machine."""

    def __init__(self, joint: Joint, response: Response) -> None:
        self.joint = joint
        self.position = self.velocity = 0.0  # as measured last
        self._at = 0.0
        self._law = ControlLaw(response.dead_time, response.lag, joint.velocity, response.droop)
        self._estimate = DriveEstimate(self._law)
        self._brake: tuple[float, float, float] | None = None  # from when, where and how fast it ramps down

    @property
    def dead_time(self) -> float:
        """As far as it is known [s]."""
        return self._law.dead_time

    def measured(self, at: float, position: float, velocity: float) -> None:
        """Take a measurement; times only go on."""
        self._at, self.position, self.velocity = at, position, velocity
        self._estimate.measured(at, position)

    def follow(self, now: float, position: float, after: float) -> float:
        """The angle to send, for a joint to be at `position` a dead time from now, and at `after` a PERIOD later."""
        return self._send(now, position, (after - position) / PERIOD)

    def brake(self, now: float) -> None:
        """Ramp down from the motion that the joint will have when commands from now on take effect."""
        most = self.joint.velocity
        velocity = self._law.predicted_velocity(now, self.position, self._at)
        self._brake = now, self._law.predicted(now, self.position, self._at), max(-most, min(most, velocity))

    def slow_down(self, now: float) -> float:
        """The angle to send while it brakes, and then holds where it has come to."""
        assert self._brake is not None
        begun, position, velocity = self._brake
        seconds = min(now - begun, self._ramp)
        slower = math.copysign(self.joint.acceleration * seconds, velocity)
        return self._send(now, position + (velocity - slower / 2) * seconds, velocity - slower)

    @property
    def _ramp(self) -> float:
        assert self._brake is not None
        return abs(self._brake[2]) / self.joint.acceleration

    def braked(self, now: float) -> bool:
        """Whether the ramp is over, also where the joint is."""
        return self._brake is not None and now - self._brake[0] > self._ramp + self.dead_time

    def begin(self) -> None:
        """Begin a motion: what is measured from now on belongs to it."""
        self._estimate.rest()
        self._brake = None

    def end(self) -> Fit | None:
        """Learn from the motion that has ended as it should."""
        return self._estimate.learn()

    def silence(self) -> None:
        """Forget what was sent: somebody else moves the drive, or holds it."""
        self._law.rest()
        self._estimate.rest()
        self._brake = None

    def _send(self, now: float, position: float, velocity: float) -> float:
        sent = self._law.command(now, self.position, position, velocity, self._at)
        self._estimate.sent(now, sent)
        return sent
