"""A machine of OperaSim in virtual time, and the way to it: its messages come late, now and then more."""

import random
from collections.abc import Callable, Mapping
from pathlib import Path

import yaml

from conftest import PROJECT
from operasim.machine import Machine
from operasim.model import Placed, Unknowns
from operasim.model import machine as prefab
from tms_config.models import MachineModel

STEP = 0.02  # s of the simulator
SLOWEST = 0.025  # s that a command takes at most, besides a step
SETTLES = 10.0  # s until a machine stands after the start

Angles = dict[str, float]


def model_of(name: str) -> MachineModel:
    """A machine file of the project."""
    path: Path = PROJECT / "configs" / "machines" / f"{name}.yaml"
    return MachineModel.model_validate(yaml.safe_load(path.read_text(encoding="utf-8")))


class Plant:
    """Its joints, their commands and what is measured of them."""

    def __init__(self, model: str, *, lag: float = 1.0, dead_time: float = 0.0, seed: int = 1) -> None:
        """`lag`, `dead_time`: factor and seconds by which the drives are not as the machine file says."""
        self.model, file = model_of(model), prefab(model)
        self._front = any(joint is not None and joint.dead_time for joint in file.joints.values())
        self._more = 0.0 if self._front else dead_time  # drives without a queue: the commands are under way longer
        unknowns = Unknowns(lag=lag, dead_time=dead_time if self._front else 0.0)
        self._machine = Machine(file, Placed(model=model, place=(0, 0, 0)), unknowns)
        for name, angle in self.model.initial.items():
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
