"""How far tracks go after a command to stop: the worst case of the model, or what this machine's receipts show."""

from dataclasses import dataclass

from tms_config.models import DRIVE, Border, MachineModel

MOST = 3.0  # times the model's distance: what shows more was no stop of these tracks
SLOWEST = 0.2  # m/s; from less, a stop shows more of the noise of the poses than of the brakes


@dataclass(frozen=True)
class Axis:
    """Travel forward [m], or turning [rad]. It answers a command as a first-order lag, or slower."""

    top: float  # 1/s
    acceleration: float  # 1/s^2
    lag: float  # s

    def braking(self, speed: float) -> float:
        """How far it goes from a speed, once the command acts: the lag, and no harder than its acceleration."""
        speed, bend = abs(speed), self.acceleration * self.lag
        if speed <= bend:
            return speed * self.lag
        return (speed**2 / self.acceleration + bend * self.lag) / 2


@dataclass(frozen=True)
class Tracks:
    """The tracks of one machine."""

    forward: Axis  # m
    turning: Axis  # rad
    dead_time: float = 0.0  # s
    factor: float = 1.0  # times the model's distances, as its receipts show

    def learned(self, speed: float, way: float) -> "Tracks":
        """The same after a stop from a speed [m/s] that took `way` [m]: a receipt may only enlarge distances."""
        if abs(speed) < SLOWEST:
            return self
        model = abs(speed) * self.dead_time + self.forward.braking(speed)
        return Tracks(self.forward, self.turning, self.dead_time, max(self.factor, min(way / model, MOST)))


def tracks_of(model: MachineModel, border: Border) -> Tracks | None:
    """The tracks of a machine; None where it has none that it could drive with."""
    drive = model.drive
    if drive is None:
        return None
    answer = model.responses(border)[DRIVE]
    return Tracks(
        Axis(drive.velocity, drive.acceleration, answer.lag),
        Axis(drive.turn_velocity, drive.turn_acceleration, answer.lag),
        answer.dead_time,
    )
