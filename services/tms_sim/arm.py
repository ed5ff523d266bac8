"""Joints that follow a reference within their limits. Pure logic."""

import math
import threading
from collections.abc import Mapping, Sequence

from tms_config.models import Joint, Response
from tms_control.reference_trajectory import Knot, ReferenceTrajectory
from tms_sim.servo import Servo

SUBSTEP = 0.01  # s: the same motion at any time scale
EXACT = 1e-9  # rad
TURN = 2  # substeps in a period of the controllers: 50 Hz


class Arm:
    """Positions [rad] and velocities [rad/s] of all joints, in the order of the controller."""

    def __init__(
        self, joints: Mapping[str, Joint], initial: Mapping[str, float], response: Mapping[str, Response]
    ) -> None:
        """`response` holds the joints that answer late and sluggishly; none: an ideal machine."""
        self.joints = dict(joints)
        self.servos = {name: Servo(joint, initial.get(name, 0.0), response.get(name)) for name, joint in joints.items()}
        self.now = 0.0  # s
        self.elapsed = 0.0  # s since the present path began; below 0 during the longest dead time
        self.more_dead_time = 0.0  # s, not known to the controllers
        self.targets: dict[str, float] = {}  # rad, of joints that turn by themselves while there is no path
        self.speeds: dict[str, float] = {}  # rad/s, of joints that turn until they are commanded something else
        self.lock = threading.RLock()  # shared by the servers of goals and the steps of time
        self._longest = max((servo.ahead for servo in self.servos.values()), default=0.0)
        self._reference: ReferenceTrajectory | None = None
        self._stuck = False
        self._owed, self._count = 0.0, 0  # s that are not stepped yet; substeps so far

    @property
    def positions(self) -> list[float]:
        """True positions [rad]."""
        return [servo.position for servo in self.servos.values()]

    @property
    def velocities(self) -> list[float]:
        """True velocities [rad/s]."""
        return [servo.velocity for servo in self.servos.values()]

    @property
    def driven(self) -> bool:
        """Whether a command moves any joint."""
        return any(servo.driven for servo in self.servos.values())

    @property
    def still(self) -> bool:
        """Whether no joint moves or will move."""
        return self._idle() and all(servo.still for servo in self.servos.values())

    @property
    def stands(self) -> bool:
        """Whether no joint moves, as far as a controller can measure."""
        return all(servo.stands for servo in self.servos.values())

    @property
    def stuck(self) -> bool:
        """Whether no joint moves, whatever is commanded; commands meanwhile are lost."""
        return self._stuck

    @stuck.setter
    def stuck(self, stuck: bool) -> None:
        if stuck and not self._stuck:
            for servo in self.servos.values():
                servo.rest()
        self._stuck = stuck

    def follow(self, names: Sequence[str], points: Sequence[Knot]) -> ReferenceTrajectory:
        """Begin a trajectory from the present state of the arm, moving or not."""
        servos = self.servos.values()
        start = Knot(0.0, tuple(s.setpoint if s.led else s.position for s in servos), tuple(s.rate for s in servos))
        self._reference, self.elapsed = ReferenceTrajectory(self.joints, start, names, points), -self._longest
        self.targets.clear()  # earlier commands must not go on afterwards
        self.speeds.clear()
        return self._reference

    def finish(self) -> None:
        """End the path and stay at its end."""
        self._reference = None

    def hold(self) -> None:
        """Give up the path and brake, each joint as soon as its dead time and its acceleration limit let it."""
        self._reference = None
        for servo in self.servos.values():
            servo.brake(self.now)

    def release(self, name: str) -> None:
        """Give up the target of one joint and brake it."""
        self.targets.pop(name, None)
        self.servos[name].brake(self.now)

    def halt(self, immediately: bool) -> None:
        """Do the emergency stop, with or without the dead time."""
        self._reference = None
        self.targets.clear()
        self.speeds.clear()
        for servo in self.servos.values():
            servo.halt(self.now, immediately, self.more_dead_time)

    def leak(self, velocity: float, seconds: float) -> None:
        """Move the first joint at a velocity [rad/s] without a command."""
        next(iter(self.servos.values())).leak(velocity, seconds)

    def step(self, seconds: float) -> None:
        """Let time pass."""
        self._owed += seconds
        count = int(self._owed / SUBSTEP + 1e-6)
        self._owed -= count * SUBSTEP
        if self._stuck or self.still:
            self.now, self.elapsed = self.now + count * SUBSTEP, self.elapsed + count * SUBSTEP
            return
        for _ in range(count):
            self._substep(SUBSTEP)

    def _substep(self, h: float) -> None:
        self.now += h
        self._count += 1
        sends = self._count % TURN == 0
        for i, (name, servo) in enumerate(self.servos.items()):
            wanted = None if servo.joint.passive else self._wanted(i, name, servo, h)
            servo.step(self.now, h, wanted)
            if sends:
                servo.send(self.now, self.more_dead_time, wanted is None)
        self.elapsed += h

    def _wanted(self, i: int, name: str, servo: Servo, h: float) -> float | None:
        """Velocity [rad/s] of a joint's reference; None: the joint has none."""
        acceleration = servo.joint.acceleration
        if self._reference is not None:
            since = self.elapsed + servo.ahead
            before, after = self._reference.joint(i, since), self._reference.joint(i, since + h)
            return (after - before) / h + _catch_up(before - servo.setpoint, acceleration, h)
        if name in self.targets:
            return _catch_up(self.targets[name] - servo.setpoint, acceleration, h)
        return self.speeds.get(name)

    def _idle(self) -> bool:
        return self._reference is None and not self.targets and not self.speeds


def _catch_up(behind: float, acceleration: float, h: float) -> float:
    """Extra velocity [rad/s] to close a gap [rad] to the reference, such that it can still brake in time."""
    if abs(behind) < EXACT:
        return 0.0
    return math.copysign(min(abs(behind) / h, math.sqrt(acceleration * abs(behind))), behind)
