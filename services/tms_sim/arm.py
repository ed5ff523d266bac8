"""Joints that follow a reference as well as their limits let them. Pure logic, same result for the same seed."""

import math
import random
from collections.abc import Mapping, Sequence

from tms_core.models import Joint
from tms_sim.path import Path, Point

SUBSTEP = 0.01  # s, at most: keeps the motion the same at any time scale


class Arm:
    """Positions [rad] and velocities [rad/s] of all joints, in the order of the controller."""

    def __init__(
        self, joints: Mapping[str, Joint], initial: Mapping[str, float], seed: int = 0, noise: float = 0.0
    ) -> None:
        """`noise` [rad] is the standard deviation of the reported positions."""
        self.joints = dict(joints)
        self.positions = [initial.get(name, 0.0) for name in self.joints]
        self.velocities = [0.0] * len(self.joints)
        self.elapsed = 0.0  # s since the present path began
        self.targets: dict[str, float] = {}  # rad, of joints that turn by themselves while there is no path
        self.speeds: dict[str, float] = {}  # rad/s, of joints that turn until they are told something else
        self.stuck = False  # nothing moves, whatever is asked
        self._path: Path | None = None
        self._noise, self._random = noise, random.Random(seed)

    def follow(self, names: Sequence[str], points: Sequence[Point]) -> Path:
        """Begin a trajectory from wherever the arm is, moving or not."""
        now = Point(0.0, tuple(self.positions), tuple(self.velocities))
        self._path, self.elapsed = Path(self.joints, now, names, points), 0.0
        self.targets.clear()  # what was commanded before must not go on afterwards
        self.speeds.clear()
        return self._path

    def hold(self) -> None:
        """Give up the path and brake, each joint as hard as its acceleration limit lets it."""
        self._path = None

    @property
    def still(self) -> bool:
        """Whether nothing moves."""
        return not any(self.velocities)

    def reading(self) -> list[float]:
        """Positions as sensors report them [rad]."""
        if not self._noise:
            return list(self.positions)
        return [position + self._random.gauss(0.0, self._noise) for position in self.positions]

    def step(self, seconds: float) -> None:
        """Let time pass."""
        if self.stuck:
            self.velocities, self.elapsed = [0.0] * len(self.joints), self.elapsed + seconds
            return
        count = max(1, math.ceil(seconds / SUBSTEP - 1e-9))
        for _ in range(count):
            if self._path is None and not self.targets and not self.speeds and self.still:
                return
            self._substep(seconds / count)

    def _substep(self, h: float) -> None:
        path = self._path
        before = path.at(self.elapsed) if path else self.positions
        after = path.at(self.elapsed + h) if path else before
        self.elapsed += h
        for i, (name, joint) in enumerate(self.joints.items()):
            wanted = 0.0 if path is None else (after[i] - before[i]) / h
            if path is not None:
                wanted += _catch_up(before[i] - self.positions[i], joint.acceleration, h)
            elif name in self.targets:
                wanted = _catch_up(self.targets[name] - self.positions[i], joint.acceleration, h)
            else:
                wanted = self.speeds.get(name, 0.0)
            self._move(i, joint, max(-joint.velocity, min(joint.velocity, wanted)), h)

    def _move(self, i: int, joint: Joint, wanted: float, h: float) -> None:
        """Change the velocity of one joint towards `wanted` [rad/s] and its position by it."""
        most = joint.acceleration * h
        velocity = self.velocities[i] + max(-most, min(most, wanted - self.velocities[i]))
        position = self.positions[i] + velocity * h
        low, high = (-math.inf if joint.min is None else joint.min), (math.inf if joint.max is None else joint.max)
        self.positions[i] = max(low, min(high, position))
        self.velocities[i] = velocity if low <= position <= high else 0.0  # the end stop


def _catch_up(behind: float, acceleration: float, h: float) -> float:
    """Extra velocity [rad/s] to close a gap [rad] to the reference, such that it can still brake in time."""
    return math.copysign(min(abs(behind) / h, math.sqrt(acceleration * abs(behind))), behind)
