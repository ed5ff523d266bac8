"""Tracks on flat ground: place, speeds, and how they answer commands. Pure logic, all in the frame `map`."""

import math

from tms_config.models import Drive, Response
from tms_sim.dead_time import DeadTime
from tms_sim.soil import Resistance

SUBSTEP = 0.02  # s: the same motion at any time scale
ZERO = 1e-3  # m/s, rad/s: a smaller command is one to brake, as in the simulator
BRAKE = 0.1  # s, lag of the brakes: far shorter than the lag of any drive
SLOW = 2e-3  # m/s, rad/s: the brakes hold what is slower


class Tracks:
    """Position [m], heading [rad], velocities [m/s, rad/s]. Without a response, only limits delay the velocities."""

    def __init__(self, drive: Drive, start: tuple[float, float, float], response: Response | None) -> None:
        self.drive = drive
        self.x, self.y, self.yaw = start
        self.v = self.w = 0.0
        self.now = 0.0  # s
        self.more_dead_time = 0.0  # s, not known to any controller
        self.leak = 0.0  # m/s, motion without a command
        self._lag = response.lag if response else None  # s
        self._commands: DeadTime[tuple[float, float]] = DeadTime(response.dead_time if response else 0.0)
        self._command = (0.0, 0.0)  # the command in effect
        self._soil = Resistance()

    @property
    def still(self) -> bool:
        """Whether no command moves the tracks or will move them."""
        return self.v == 0.0 and self.w == 0.0 and all(map(_brakes, (self._command, *self._commands.under_way)))

    def send(self, v: float, w: float) -> None:
        """Command velocities [m/s, rad/s], which stay until the next command."""
        self._commands.put(self.now, (v, w), self.more_dead_time)

    def resist(self, share: float) -> None:
        """Leave them a share of their fastest speed, in the direction in which they push a blade through soil."""
        self._soil.meet(share, self.v)

    def brake_at_once(self) -> None:
        """Do an emergency stop without dead time: commands under way are lost."""
        self._commands.clear()
        self._command = (0.0, 0.0)

    def lead(self, v: float, w: float, h: float) -> None:
        """Send the command that brings the tracks to these velocities, within their limits, `h` seconds from now."""
        v = self._leading(self.v, v, self.drive.acceleration * h, h)
        w = self._leading(self.w, w, self.drive.turn_acceleration * h, h)
        if self._lag is not None and max(abs(v), abs(w)) < ZERO <= abs(self.v):
            v = ZERO  # slow down without the brakes
        self.send(v, w)

    def _leading(self, now: float, wanted: float, most: float, h: float) -> float:
        if self._lag is None:
            return wanted
        return now + cut(wanted - now, most) / -math.expm1(-h / self._lag)

    def move(self, h: float) -> None:
        """Let `h` seconds pass."""
        self.now += h
        for command in self._commands.due(self.now):
            self._command = command
        v, w = self._command
        self.v = cut(self.v, self._soil.limit(self.v, self.drive.velocity))
        v = cut(v, self._soil.limit(v, self.drive.velocity))
        self.v = self._answer(self.v, v, self.drive.acceleration, h)
        self.w = self._answer(self.w, w, self.drive.turn_acceleration, h)
        self.yaw = math.remainder(self.yaw + self.w * h, math.tau)
        self.x += (self.v * math.cos(self.yaw) + self.leak) * h
        self.y += self.v * math.sin(self.yaw) * h

    def _answer(self, now: float, wanted: float, acceleration: float, h: float) -> float:
        if self._lag is None:
            return now + cut(wanted - now, acceleration * h)
        brakes = _brakes(self._command)
        lag, wanted = (BRAKE, 0.0) if brakes else (self._lag, wanted)
        found = wanted - (wanted - now) * math.exp(-h / lag)
        return 0.0 if wanted == 0.0 and abs(found) < SLOW and brakes else found


def _brakes(command: tuple[float, float]) -> bool:
    return max(map(abs, command)) < ZERO


def cut(value: float, most: float) -> float:
    """The value, limited to plus and minus `most`."""
    return max(-most, min(most, value))
