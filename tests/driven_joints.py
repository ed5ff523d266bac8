"""The stand-in of OperaSim-PhysX under an arm controller, in virtual time: its messages come late, some more."""

import math
import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from conftest import PROJECT
from operasim.machine import Machine
from operasim.model import Placed, Unknowns
from operasim.model import machine as prefab
from tms_config.models import DRIVE, Joint, MachineModel
from tms_config.yaml_file import parse
from tms_control.arm_controller import ArmController
from tms_control.arm_motion import ArmMotion, Tolerances
from tms_control.reference_trajectory import Knot, ReferenceTrajectory

STEP = 0.02  # s of the simulator
SLOWEST = 0.025  # s that a command takes at most, besides a step
SETTLES = 10.0  # s until a machine stands after the start
NEAR = 0.03  # rad off the reference that count as arrived
LEAVES = 70.0  # s after which a goal must have ended
NONE = Tolerances()

Angles = dict[str, float]


def model_of(name: str) -> MachineModel:
    """A machine file of the project."""
    return parse(PROJECT / "configs" / "machines" / f"{name}.yaml", MachineModel)


class Plant:
    """Its joints, their commands and what is measured of them."""

    def __init__(self, model: str, *, lag: float = 1.0, dead_time: float = 0.0, seed: int = 1) -> None:
        """`lag`, `dead_time`: factor and seconds by which the drives are not as the machine file says."""
        self.model, file = model_of(model), prefab(model)
        self._front = any(joint is not None and joint.dead_time for joint in file.joints.values())
        self._more = 0.0 if self._front else dead_time  # drives without a queue: the commands are under way longer
        unknowns = Unknowns(lag=lag, dead_time=dead_time if self._front else 0.0)
        self._machine = Machine(file, Placed(model=model, place=(0, 0, 0)), unknowns)
        start = {**self.model.initial, **self.model.borders["physx"].initial}
        for name, angle in start.items():
            joint = self._machine.joints.get(name)
            if joint is not None:
                joint.position = joint.target = angle
        self._late, self._coming = random.Random(seed), list[tuple[float, Angles]]()
        self.now = 0.0  # s
        self.wait(SETTLES)

    def wait(self, seconds: float) -> None:
        """Let time pass without commands."""
        for _ in range(round(seconds / STEP)):
            self.step()

    def send(self, angles: Mapping[str, float]) -> None:
        """Command angles; they arrive a little later."""
        self._coming.append((self.now + self._more + self._late.uniform(0.0, SLOWEST), dict(angles)))

    def step(self) -> None:
        """One step of the simulator."""
        self.now += STEP
        due = [angles for arrives, angles in self._coming if arrives <= self.now]
        self._coming = [one for one in self._coming if one[0] > self.now]
        for angles in due:
            self._take(angles)
        self._machine.scripts(self.now)
        self._machine.physics(STEP)

    def _take(self, angles: Angles) -> None:
        if self._front:
            self._machine.joint_cmd(list(angles), list(angles.values()), self.now)
        else:
            for name, angle in angles.items():
                self._machine.angle(name, angle)

    def block(self, name: str, angle: float) -> None:
        """Keep a joint from going on beyond an angle, as rock does."""
        joint = self._machine.joints[name]
        assert joint is not None
        joint.model = type(joint.model)(**{**vars(joint.model), "high": angle})

    @property
    def positions(self) -> Angles:
        """True angles of all joints of the machine file [rad]."""
        return self._of(lambda joint: joint.position)

    @property
    def velocities(self) -> Angles:
        """True velocities [rad/s]."""
        return self._of(lambda joint: joint.velocity)

    def _of(self, value: Callable[..., float]) -> Angles:
        joints = self._machine.joints
        return {name: 0.0 if joints.get(name) is None else value(joints[name]) for name in self.model.joints}


@dataclass
class Seen:
    """What a move has shown."""

    worst: float = 0.0  # rad
    settled: float = 0.0  # s after the end of the reference


class DrivenJoints:
    """A controller at 50 Hz that hears of the joints at 25 Hz."""

    def __init__(self, model: str, *, lag: float = 1.0, dead_time: float = 0.0, streams: bool = False) -> None:
        """`streams`: it sends the reference of the moment, as a controller does that knows nothing of the drives."""
        self.plant = Plant(model, lag=lag, dead_time=dead_time)
        found = self.plant.model
        responses = found.responses(found.borders["physx"])
        self.arm = ArmController(found.joints, {name: one for name, one in responses.items() if name != DRIVE})
        self.sent: Angles = {}
        self._streams, self._ticks = streams, 0

    def tick(self, motion: ArmMotion | None = None) -> None:
        """One period."""
        self._ticks += 1
        if self._ticks % 2:
            self.arm.measured(self.plant.now, self.plant.positions, self.plant.velocities)
        self.sent = self.arm.step(self.plant.now)
        if self._streams and motion is not None:
            self.sent = {name: self.wanted(motion, name) for name in self.arm.servos}
        if self.sent:
            self.plant.send(self.sent)
        self.plant.step()

    def begin(self, joint: str, way: float, tolerances: Tolerances = NONE) -> ArmMotion:
        """Move one joint by `way` rad as a planner would: at rest at both ends."""
        now = self.plant.positions
        self.arm.measured(self.plant.now, now, self.plant.velocities)
        goal = {**now, joint: now[joint] + way}
        seconds = _duration(self.plant.model.joints[joint], abs(way))
        points = [_knot(now, goal, share / 20, seconds) for share in range(21)]
        reference = ReferenceTrajectory(self.plant.model.joints, points[0], list(now), points)
        return self.arm.begin(self.plant.now, reference, tolerances)

    def until(self, motion: ArmMotion, joint: str = "") -> Seen:
        """Go on until the goal has ended, and for a second more."""
        seen, ends = Seen(), motion.begun + motion.reference.duration
        left = LEAVES
        while left > 0.0 and (motion.verdict is None or self.plant.now < ends + 1.0):
            self.tick(motion)
            left -= STEP
            if joint:
                off = abs(self.plant.positions[joint] - self.wanted(motion, joint))
                seen.worst = max(seen.worst, off)
                seen.settled = self.plant.now - ends if off > NEAR else seen.settled
        assert motion.verdict is not None, "it does not end"
        return seen

    def wanted(self, motion: ArmMotion, joint: str) -> float:
        """Where a joint should be now [rad]."""
        return motion.reference.joint(list(self.plant.model.joints).index(joint), self.plant.now - motion.begun)


def _duration(joint: Joint, way: float) -> float:
    return 1.1 * max(1.5 * way / joint.velocity, math.sqrt(6 * way / joint.acceleration))


def _knot(begin: Angles, end: Angles, share: float, seconds: float) -> Knot:
    way, speed = share * share * (3 - 2 * share), 6 * share * (1 - share) / seconds
    return Knot(
        share * seconds,
        tuple(begin[name] + (end[name] - begin[name]) * way for name in begin),
        tuple((end[name] - begin[name]) * speed for name in begin),
    )
