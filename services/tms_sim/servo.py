"""One joint of a stand-in: the setpoint of its controller, and the drive that follows it. Pure logic."""

import math

from tms_config.models import Joint, Response
from tms_control.control_law import ControlLaw
from tms_sim.drive import JointDrive
from tms_sim.soil import Resistance

SETTLED = 1e-3  # rad and rad/s, within which the controller ends its commands
STANDS = 5e-3  # rad/s, slower than this it counts as standing for a goal that is being cancelled


class Servo:
    """A joint without a response is at its setpoint, within its limits."""

    def __init__(self, joint: Joint, position: float, response: Response | None) -> None:
        self.joint = joint
        self.setpoint, self.rate = position, 0.0  # rad, rad/s: the reference `ahead` seconds from now
        self.led = False  # the controller sends commands
        self._leak = 0.0  # rad/s, motion without a command
        self._stood = math.inf  # s since the setpoint came to stand
        self._braking = self._halted = False
        self._soil = Resistance()
        self._drive = JointDrive(joint, response, position, self._soil) if response else None
        self._law = ControlLaw(response.dead_time, response.lag, joint.velocity) if response else None

    @property
    def ahead(self) -> float:
        """How far the setpoint is ahead of the time [s]: the known dead time."""
        return self._law.dead_time if self._law else 0.0

    @property
    def position(self) -> float:
        """True position [rad]."""
        return self._drive.position if self._drive else self.setpoint

    @property
    def velocity(self) -> float:
        """True velocity [rad/s]."""
        return (self._drive.velocity if self._drive else self._soil.slowed(self.rate)) + self._leak

    @property
    def driven(self) -> bool:
        """Whether a command moves it."""
        return (self._drive.velocity if self._drive else self.rate) != 0.0

    @property
    def still(self) -> bool:
        """Whether it stands, and neither its controller nor a command under way will change that."""
        return not self.led and self.rate == 0.0 and (self._drive is None or self._drive.still)

    @property
    def stands(self) -> bool:
        """Whether a cancelled goal is over, as far as a controller can measure."""
        if self._drive is None:
            return self.still
        if self._halted:
            return self._drive.slower(STANDS)
        return self._stood >= self.ahead and abs(self._drive.velocity) <= STANDS

    def step(self, now: float, h: float, wanted: float | None) -> None:
        """Let `h` seconds pass up to `now`; `wanted` is the velocity [rad/s] of the reference, None: there is none."""
        if self._drive is not None:
            self._drive.step(now, h)
        if wanted is not None:
            self._wake()
        self._move(wanted or 0.0, h)
        self._stood = 0.0 if wanted or self.rate else self._stood + h

    def send(self, now: float, more: float, done: bool) -> None:
        """Do one period of the controller; `more` [s] is dead time unknown to it, `done`: there is no reference."""
        drive, law = self._drive, self._law
        if drive is None or law is None or not self.led:
            return
        if self._braking and self.rate == 0.0:  # the ramp is over: hold the position that it leads to
            self.setpoint, self._braking = law.predicted(now, drive.position), False
        drive.send(law.command(now, drive.position, self.setpoint, self.rate), now, more)
        near = abs(self.setpoint - drive.position) < SETTLED and abs(drive.velocity) < SETTLED
        if done and near and self._stood > self.ahead:
            drive.send(self.setpoint, now, more)  # the setpoint itself, without a lead
            self.led = False
            law.rest()

    def brake(self, now: float) -> None:
        """Ramp down from the position that the joint will have when commands from now on take effect."""
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
        """Stand from this moment on; commands under way are lost."""
        if self._drive is not None and self._law is not None:
            self._drive.rest()
            self._law.rest()
        self.led, self.rate, self._stood, self._halted = False, 0.0, math.inf, False
        self.setpoint = self.position

    def resist(self, share: float) -> None:
        """Leave it a share of its free speed, in the direction in which it moves."""
        self._soil.meet(share, self.velocity)

    def leak(self, velocity: float, h: float) -> None:
        """Move without a command, within the end stops."""
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
        rate = self.rate if self._drive else self._soil.slowed(self.rate)
        position = self.setpoint + rate * h
        self.setpoint = self._within(position)
        if self.setpoint != position:
            self.rate = 0.0  # the end stop

    def _within(self, position: float) -> float:
        low, high = self.joint.min, self.joint.max
        return max(-math.inf if low is None else low, min(math.inf if high is None else high, position))
