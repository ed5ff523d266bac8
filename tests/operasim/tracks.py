"""Two tracks: a speed controller, brakes and the odometry of their middle wheels. Pure; m, s, rad, N m."""

import math
from dataclasses import dataclass

BRAKE_BELOW = 0.001  # m/s, a slower command brakes
WHEELS = 3  # of each track


@dataclass(frozen=True)
class TrackModel:
    """Constants of both tracks."""

    mass: float  # kg, of the machine
    half_tread: float  # m
    radius: float  # m, of a wheel
    p: float  # N m per m/s, of each wheel
    i: float
    d: float
    torque: float  # N m, limit of each wheel
    brake: float  # N m, of each wheel
    fastest: float  # m/s and rad/s, limit of a Twist
    divisor: float  # of the yaw rate of the odometry


class Track:
    """One track. Its controller is never reset, and goes on while it brakes."""

    def __init__(self, model: TrackModel) -> None:
        self._model = model
        self.command = self.speed = 0.0  # m/s
        self._sum = self._error = 0.0

    def step(self, seconds: float) -> None:
        """Move on by one step of the engine."""
        model, error = self._model, self.command - self.speed
        self._sum += error * seconds
        wanted = model.p * error + model.i * self._sum + model.d * (error - self._error) / seconds
        self._error = error
        motor = min(max(wanted, -model.torque), model.torque)
        self.speed += motor * self._gain * seconds
        if abs(self.command) < BRAKE_BELOW:
            left = abs(self.speed) - model.brake * self._gain * seconds
            self.speed = math.copysign(max(left, 0.0), self.speed)

    @property
    def residual(self) -> float:
        """What the integral part of the controller still asks for, in N m."""
        return self._model.i * self._sum

    @property
    def _gain(self) -> float:
        """m/s2 per N m of each wheel; a track moves half of the machine."""
        return 2 * WHEELS / (self._model.mass * self._model.radius)


class Tracks:
    """Both tracks and what the odometry makes of them. The last command holds for ever."""

    def __init__(self, model: TrackModel) -> None:
        self._model = model
        self.left, self.right = Track(model), Track(model)
        self.odometry = (0.0, 0.0, 0.0)  # x, y, yaw

    def twist(self, forward: float, turn: float) -> None:
        """Take a Twist [m/s, rad/s], limited."""
        most, half = self._model.fastest, self._model.half_tread
        v, w = min(max(forward, -most), most), min(max(turn, -most), most)
        self.left.command, self.right.command = v - half * w, v + half * w

    def stop(self) -> None:
        """Brake until the next command."""
        self.left.command = self.right.command = 0.0

    def step(self, seconds: float) -> None:
        """Move on by one step of the engine."""
        self.left.step(seconds)
        self.right.step(seconds)
        x, y, yaw = self.odometry
        yaw += self.odometry_turn * seconds
        self.odometry = (x + self.forward * math.cos(yaw) * seconds, y + self.forward * math.sin(yaw) * seconds, yaw)

    @property
    def forward(self) -> float:
        """Speed in m/s."""
        return (self.left.speed + self.right.speed) / 2

    @property
    def turn(self) -> float:
        """Yaw rate that the wheels' speeds alone would give, in rad/s."""
        return (self.right.speed - self.left.speed) / (2 * self._model.half_tread)

    @property
    def odometry_turn(self) -> float:
        """Yaw rate of the odometry: a part of the real one."""
        return self.turn / self._model.divisor
