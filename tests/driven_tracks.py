"""The stand-in of OperaSim-PhysX under a trip, in virtual time: poses and commands come late, some poses never."""

import math
import random
from collections.abc import Callable
from functools import cache

from conftest import PROJECT
from operasim.machine import Machine
from operasim.model import Placed, Unknowns, machine
from tms_config.models import DRIVE, Drive, MachineModel, Response
from tms_config.yaml_file import parse
from tms_control.ground import Body, Ground, Outline
from tms_control.path import Pose
from tms_control.track_estimate import Command, PoseSample, TrackEstimate
from tms_control.trip import Trip
from tms_control.trip_task import Task

TICK = 0.01  # s
ENGINE = 2  # ticks a step
POSES = {"mst110cr": 12}  # ticks between poses; of the others:
OFTEN = 6
LOOK = 10  # ticks between two looks around
LATEST = 0.05  # s that a pose or a command may be late
MODELS = ("zx200", "ic120", "mst110cr", "zx120")
GAINS = (1 / 3, 0.6, 1.0)


@cache
def model(name: str) -> MachineModel:
    return parse(PROJECT / "configs" / "machines" / f"{name}.yaml", MachineModel)


class DrivenTracks:
    """A machine at 0, 0 that looks along x."""

    def __init__(
        self,
        name: str,
        gain: float = 0.6,
        *,
        control: int = 5,
        jitter: float = 0.0,
        lag: float = 1.0,
        pivot: float = 0.0,
    ) -> None:
        """Commands go out every `control` ticks; its lag is `lag` times what is thought; it turns round `pivot` [m]."""
        found, response = model(name).drive, model(name).response[DRIVE]
        assert found is not None
        self.drive: Drive = found
        self.machine = Machine(machine(name), Placed(model=name, place=(0.0, 0.0, 0.0)), Unknowns(yaw_gain=gain))
        self.estimate = TrackEstimate(Response(**response.model_dump() | {"lag": response.lag / lag}))
        self.outline = Outline.of(model(name))
        self.ground = Ground()
        self.blind = self.stuck = False  # no pose arrives; nothing moves it
        self.now = 0.0
        self.sent: list[Command] = []
        self.been: list[Pose] = []
        self._ticks, self._period, self._control = 0, POSES.get(name, OFTEN), control
        self._jitter, self._pivot = jitter, pivot
        self._chance = random.Random(1)
        self._poses: list[tuple[float, PoseSample]] = []  # under way, with their arrival
        self._commands: list[tuple[float, Command]] = []

    @property
    def pose(self) -> Pose:
        """What is told of where it is, but for the jitter: a place that turns round the pivot."""
        base = self.machine.base
        return Pose(base.x, base.y, base.yaw).ahead(-self._pivot)

    @property
    def speed(self) -> float:
        """m/s of the faster track."""
        return max(abs(self.machine.tracks.left.speed), abs(self.machine.tracks.right.speed))

    def trip(self, task: Task) -> Trip:
        return Trip(task, self.drive, self.estimate, self.now, self.outline, self.ground)

    def stands(self, *bodies: Body) -> None:
        """These stand around it from now on."""
        self.ground = Ground(bodies)

    def run(self, trip: Trip, seconds: float = 600.0, until: Callable[[], bool] = lambda: False) -> None:
        """Go on until the trip has ended, or this is true after one of its steps, or for this long."""
        end = self.now + seconds
        while trip.verdict is None and self.now < end and not (self._ticks % self._control == 0 and until()):
            self.tick(trip)

    def tick(self, trip: Trip) -> None:
        self._ticks, self.now = self._ticks + 1, self.now + TICK
        if self._ticks % ENGINE == 0:
            self._step_engine()
        if self._ticks % self._period == 0 and not self.blind:
            self._poses.append((self._late(), PoseSample(self.now, self._told())))
        if self._ticks % self._control == 0:
            self._step_trip(trip)
        if self._ticks % LOOK == 0 and self._ticks > LOOK:
            trip.see(self.now, self.ground)
            if trip.asked is not None:
                trip.answer(self.now, trip.asked.answer())

    def kick(self, yaw: float, beside: float = 0.0) -> None:
        """Something turns it and moves it to the left."""
        base = self.machine.base
        base.x, base.y = base.x - beside * math.sin(base.yaw), base.y + beside * math.cos(base.yaw)
        base.yaw += yaw

    def _told(self) -> Pose:
        return Pose(*(one + self._chance.gauss(0.0, self._jitter) for one in self.pose))

    def _step_engine(self) -> None:
        while self._commands and self._commands[0][0] <= self.now:
            command = self._commands.pop(0)[1]
            self.machine.tracks.twist(command.v, command.w)
        if self.stuck:
            self.machine.tracks.left.speed = self.machine.tracks.right.speed = 0.0
        else:
            self.machine.physics(ENGINE * TICK)
        self.been.append(self.pose)

    def _step_trip(self, trip: Trip) -> None:
        sample = None
        while self._poses and self._poses[0][0] <= self.now:
            sample = self._poses.pop(0)[1]
        command = trip.step(self.now, sample)
        if command is not None:
            self.sent.append(command)
            self._commands.append((self._late(), command))

    def _late(self) -> float:
        return self.now + self._chance.uniform(0.0, LATEST)
