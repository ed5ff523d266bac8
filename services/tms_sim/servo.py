"""One joint of a stand-in: where its controller leads it, and the drive that follows. Pure logic."""

import math

from tms_config.models import Joint, Response
from tms_sim.control_law import ControlLaw
from tms_sim.drive import Drive

SETTLED = 1e-3  # rad and rad/s, then the controller is done with it
STANDS = 5e-3  # rad/s, slower than this it counts as standing for a goal that is being cancelled


class Servo:
    """Without a response the joint is where it is led to, within its limits."""

    def __init__(self, joint: Joint, position: float, response: Response | None) -> None:
        self.joint = joint
        self.setpoint, self.rate = position, 0.0  # rad, rad/s: where it is led to, `ahead` from now
        self.led = False  # the controller sends commands
        self._leak = 0.0  # rad/s, it moves without being told
        self._stood = math.inf  # s since the setpoint came to stand
        self._braking = self._halted = False
        self._drive = Drive(joint, response, position) if response else None
        self._law = ControlLaw(response.dead_time, response.lag, joint.velocity) if response else None

    @property
    def ahead(self) -> float:
        """How far ahead of the time the setpoint is [s]: the dead time, as far as it is known."""
        return self._law.dead_time if self._law else 0.0

    @property
    def position(self) -> float:
        """True position [rad]."""
        return self._drive.position if self._drive else self.setpoint

    @property
    def velocity(self) -> float:
        """True velocity [rad/s]."""
        return (self._drive.velocity if self._drive else self.rate) + self._leak

    @property
    def driven(self) -> bool:
        """Whether it moves because it was commanded to."""
        return (self._drive.velocity if self._drive else self.rate) != 0.0

    @property
    def still(self) -> bool:
        """Whether it stands, and neither its controller nor a command under way will change that."""
        return not self.led and self.rate == 0.0 and (self._drive is None or self._drive.still)

    @property
    def stands(self) -> bool:
        """Whether a goal that was cancelled is over, as far as a controller can tell."""
        if self._drive is None:
            return self.still
        if self._halted:
            return self._drive.slower(STANDS)
        return self._stood >= self.ahead and abs(self._drive.velocity) <= STANDS

    def step(self, now: float, h: float, wanted: float | None) -> None:
        """Let `h` seconds pass up to `now`; `wanted` is the velocity [rad/s] to lead it with, None: nothing to do."""
        if self._drive is not None:
            self._drive.step(now, h)
        if wanted is not None:
            self._wake()
        self._move(wanted or 0.0, h)
        self._stood = 0.0 if wanted or self.rate else self._stood + h

    def send(self, now: float, more: float, done: bool) -> None:
        """One turn of the controller; `more` [s] is dead time that it does not know of, `done`: nothing is wanted."""
        drive, law = self._drive, self._law
        if drive is None or law is None or not self.led:
            return
        if self._braking and self.rate == 0.0:  # the ramp is over: hold where this leaves the joint
            self.setpoint, self._braking = law.predicted(now, drive.position), False
        drive.send(law.command(now, drive.position, self.setpoint, self.rate), now, more)
        near = abs(self.setpoint - drive.position) < SETTLED and abs(drive.velocity) < SETTLED
        if done and near and self._stood > self.ahead:
            drive.send(self.setpoint, now, more)  # not an angle that leads
            self.led = False
            law.rest()

    def brake(self, now: float) -> None:
        """Ramp down from where the joint will be when what is sent from now on takes effect."""
        drive, law, most = self._drive, self._law, self.joint.velocity
        if drive is not None and law is not None and self.led:
            self.rate = max(-most, min(most, law.predicted_velocity(now, drive.position)))
            self.setpoint, self._braking = law.predicted(now, drive.position), True

    def halt(self, now: float, immediately: bool, more: float) -> None:
        """Emergency stop."""
        if self._drive is not None and self._law is not None:
            self._drive.halt(now, immediately, more)
            self._law.rest()
            self.led, self.rate, self._halted = False, 0.0, True

    def rest(self) -> None:
        """It stands from this moment on, whatever is under way."""
        if self._drive is not None and self._law is not None:
            self._drive.rest()
            self._law.rest()
        self.led, self.rate, self._stood, self._halted = False, 0.0, math.inf, False
        self.setpoint = self.position

    def leak(self, velocity: float, h: float) -> None:
        """Move without being told, as far as the end stops let it."""
        before = self.position
        if velocity and self._drive is not None:
            self._drive.shift(velocity * h)
            self.setpoint += velocity * h
        elif velocity:
            self.setpoint = self._within(before + velocity * h)
        self._leak = (self.position - before) / h

    def _wake(self) -> None:
        self._braking = self._halted = False
        if self._drive is not None and not self.led:
            self.led, self.setpoint, self.rate = True, self._drive.position, 0.0

    def _move(self, wanted: float, h: float) -> None:
        """Change the setpoint's velocity towards `wanted` [rad/s] and its position by it."""
        joint, most = self.joint, self.joint.acceleration * h
        wanted = max(-joint.velocity, min(joint.velocity, wanted))
        self.rate += max(-most, min(most, wanted - self.rate))
        position = self.setpoint + self.rate * h
        self.setpoint = self._within(position)
        if self.setpoint != position:
            self.rate = 0.0  # the end stop

    def _within(self, position: float) -> float:
        low, high = self.joint.min, self.joint.max
        return max(-math.inf if low is None else low, min(math.inf if high is None else high, position))
