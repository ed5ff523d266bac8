"""The stand-in of OperaSim-PhysX under a trip, in virtual time: poses and commands come late, some poses never."""

import math
import random
from collections.abc import Callable
from functools import cache

from conftest import PROJECT
from operasim.machine import Machine
from operasim.model import Placed, Unknowns, machine
from tms_config.models import DRIVE, Drive, MachineModel
from tms_config.yaml_file import parse
from tms_control.path import Pose
from tms_control.track_estimate import Command, PoseSample, TrackEstimate
from tms_control.trip import Task, Trip

TICK = 0.01  # s
ENGINE, CONTROL = 2, 5  # ticks
POSES = {"mst110cr": 12}  # ticks between poses; of the others:
OFTEN = 6
LATEST = 0.05  # s that a pose or a command may be late
MODELS = ("zx200", "ic120", "mst110cr", "zx120")
GAINS = (1 / 3, 0.6, 1.0)


@cache
def model(name: str) -> MachineModel:
    return parse(PROJECT / "configs" / "machines" / f"{name}.yaml", MachineModel)


def drive(name: str) -> Drive:
    found = model(name).drive
    assert found is not None
    return found


class DrivenTracks:
    """A machine at 0, 0 that looks along x."""

    def __init__(self, name: str, gain: float, seed: int = 0) -> None:
        self.name, self.drive = name, drive(name)
        self.machine = Machine(machine(name), Placed(model=name, place=(0.0, 0.0, 0.0)), Unknowns(yaw_gain=gain))
        self.estimate = TrackEstimate(model(name).response[DRIVE])
        self.blind = False  # no pose arrives
        self.noise = 0.0  # m, rad
        self.slip = 0.0  # m/s to the side while it turns
        self.latest = LATEST
        self.sent: list[tuple[float, Command]] = []
        self.been: list[Pose] = []
        self._tick = 0
        self._chance = random.Random(seed)
        self._poses: list[tuple[float, PoseSample]] = []  # under way, with their arrival
        self._commands: list[tuple[float, Command]] = []

    @property
    def now(self) -> float:
        return self._tick * TICK

    @property
    def pose(self) -> Pose:
        base = self.machine.base
        return Pose(base.x, base.y, base.yaw)

    @property
    def speed(self) -> float:
        """m/s of the faster track."""
        return max(abs(self.machine.tracks.left.speed), abs(self.machine.tracks.right.speed))

    def trip(self, task: Task) -> Trip:
        return Trip(task, self.drive, self.estimate, self.now)

    def run(self, trip: Trip, seconds: float, until: Callable[[], bool] = lambda: False) -> None:
        """Go on until the trip has ended, or this is true, or for this long."""
        end = self.now + seconds
        while trip.verdict is None and self.now < end and not until():
            self.tick(trip)

    def tick(self, trip: Trip) -> None:
        self._tick += 1
        if self._tick % ENGINE == 0:
            self.step_engine()
        if self._tick % POSES.get(self.name, OFTEN) == 0 and not self.blind:
            self._poses.append((self._late(), PoseSample(self.now, self._noisy())))
        if self._tick % CONTROL == 0:
            self._control(trip)

    def _noisy(self):
        return Pose(*(one + self._chance.gauss(0, self.noise) for one in self.pose))

    def step_engine(self) -> None:
        while self._commands and self._commands[0][0] <= self.now:
            command = self._commands.pop(0)[1]
            self.machine.tracks.twist(command.v, command.w)
        self.machine.physics(ENGINE * TICK)
        w=self.machine.tracks.turn
        b=self.machine.base
        b.x += -math.sin(b.yaw)*self.slip*(w>0.05)*.02; b.y += math.cos(b.yaw)*self.slip*(w>0.05)*.02
        self.been.append(self.pose)

    def _control(self, trip: Trip) -> None:
        sample = None
        while self._poses and self._poses[0][0] <= self.now:
            sample = self._poses.pop(0)[1]
        command = trip.step(self.now, sample)
        if command is not None:
            self.sent.append((self.now, command))
            self._commands.append((self._late(), command))

    def _late(self) -> float:
        return self.now + self._chance.uniform(0.0, self.latest)
