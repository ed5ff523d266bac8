"""Simulates how a joint's hydraulics answer commanded angles: dead time, lag, end stops. Pure logic.

dq/dt = (u(t - D) - q) / tau, as in the simulator, whose drives were fitted to the real machines. The torque limit
shapes only how a motion starts and ends. It is given as an acceleration: the simulator's torque gives the swing of a
zx200 about twice the acceleration that its motions are planned with.
"""

import math

from tms_config.models import Joint, Response
from tms_sim.dead_time import DeadTime
from tms_sim.soil import Resistance

TORQUE = 2.0  # times the acceleration limit of planned motions
STICKS = 5e-4  # rad/s, slower than this a joint stands when no command is under way


class JointDrive:
    """One joint: true position [rad] and velocity [rad/s]."""

    def __init__(self, joint: Joint, response: Response, position: float, soil: Resistance | None = None) -> None:
        """`soil`: what slows it."""
        self.position, self.velocity = position, 0.0
        self._soil = soil or Resistance()
        self._lag, self._most = response.lag, TORQUE * joint.acceleration
        self._low = -math.inf if joint.min is None else joint.min
        self._high = math.inf if joint.max is None else joint.max
        self._commands: DeadTime[float | None] = DeadTime(response.dead_time)
        self._target: float | None = None  # rad; None: the valve is shut

    @property
    def still(self) -> bool:
        """Whether it stands and no command is under way."""
        return self._target is None and self.velocity == 0.0 and not self._commands

    def slower(self, velocity: float) -> bool:
        """Whether it moves slower than this [rad/s], and neither its target nor a command under way speeds it up."""
        towards = 0.0 if self._target is None else (self._target - self.position) / self._lag
        return not self._commands and max(abs(self.velocity), abs(towards)) < velocity

    def send(self, angle: float, now: float, more: float = 0.0) -> None:
        """Command an angle [rad], which the end stops may limit; `more` [s] lengthens the dead time."""
        self._commands.put(now, angle, more)

    def halt(self, now: float, immediately: bool, more: float = 0.0) -> None:
        """Do the emergency stop: hold the position at its effect. `immediately`: commands under way are dropped."""
        if immediately:
            self._commands.clear()
            self._target = self.position
        else:
            self._commands.put(now, None, more)

    def rest(self) -> None:
        """Stand from this moment on; commands under way are lost."""
        self._commands.clear()
        self._target, self.velocity = None, 0.0

    def shift(self, way: float) -> None:
        """Move by `way` [rad] without a command, as by a leak."""
        self.position = max(self._low, min(self._high, self.position + way))
        if self._target is not None:
            self._target += way

    def step(self, now: float, h: float) -> None:
        """Let `h` seconds pass up to `now`."""
        for angle in self._commands.due(now):
            self._target = self.position if angle is None else angle
        if self._target is None:
            return
        wanted = (self._target - self.position) / self._lag
        change, slowed = self._most * h, self._soil.slowed(wanted)
        self.velocity = self._soil.braked(self.velocity, slowed)
        self.velocity += max(-change, min(change, slowed - self.velocity))
        position = self.position + self.velocity * h
        self.position = max(self._low, min(self._high, position))
        if position != self.position:
            self.velocity = wanted = 0.0  # the end stop
        if not self._commands and abs(self.velocity) < STICKS and abs(wanted) < STICKS:
            self._target, self.velocity = None, 0.0
