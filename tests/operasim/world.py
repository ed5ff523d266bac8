"""A scene that runs: frames, and between them steps of the engine. Pure; its time begins at 0."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from operasim import messages, model
from operasim.cdr import CdrError
from operasim.inputs import take
from operasim.machine import Machine
from operasim.messages import Layout
from operasim.model import Input, MachineFile, Output, Scene, Unknowns
from operasim.outputs import Interval, named, tell

STEP = 0.02  # s
LONGEST = 0.333  # s that one frame may make up for: on a slow PC, simulated time falls behind
CLOCK = 1 / 50  # s

Send = Callable[[str, bytes], None]
Trouble = Callable[[str, str], None]  # topic, why its message had no effect


@dataclass
class Told:
    """A topic that is told again and again."""

    topic: str
    machine: Machine
    output: Output
    interval: Interval


class World:
    """The machines of a scene. Messages are taken once a frame, and have their effect in the next step."""

    def __init__(
        self, scene: Scene, unknowns: Unknowns, layout: Layout, send: Send, trouble: Trouble = lambda topic, why: None
    ) -> None:
        self._layout, self._send, self._trouble = layout, send, trouble
        self.files: dict[str, MachineFile] = {name: model.machine(one.model) for name, one in scene.machines.items()}
        self.machines = {name: Machine(self.files[name], placed, unknowns) for name, placed in scene.machines.items()}
        self.time = 0.0  # s, of the last frame
        self._steps = 0
        self._clock = -math.inf
        self._heard: dict[str, list[tuple[Machine, Input]]] = {}
        self._by_frame: list[Told] = []  # IMUs
        self._by_step: list[Told] = []
        for name, file in self.files.items():
            self._add(name, file)

    def frame(self, seconds: float, heard: Iterable[tuple[str, bytes]]) -> None:
        """Go on by a frame of simulated seconds, then take what was heard: topics and messages."""
        before = self.time
        self.time += min(seconds, LONGEST)
        while (self._steps + 1) * STEP <= self.time + 1e-9:
            self._step()
        for topic, message in heard:
            self._take(topic, message)
        self._tell(self._by_frame, self.time, self.time - before)
        if self.time - self._clock > CLOCK:
            self._clock = self.time
            self._send("clock", messages.clock(self.time))

    def truth(self) -> dict[str, Any]:
        """How all really is, as JSON."""
        return {"time": self.time, "machines": {name: _truth(one) for name, one in self.machines.items()}}

    def _add(self, name: str, file: MachineFile) -> None:
        machine = self.machines[name]
        for topic, one in file.inputs.items():
            self._heard.setdefault(topic.format(name=name), []).append((machine, one))
        for topic, output in file.outputs.items():
            told = Told(topic.format(name=name), machine, named(output, name), Interval(output.period))
            (self._by_frame if output.kind == "imu" else self._by_step).append(told)

    def _step(self) -> None:
        self._steps += 1
        now = self._steps * STEP
        for machine in self.machines.values():
            machine.scripts(now)
        self._tell(self._by_step, now, STEP)
        for machine in self.machines.values():
            machine.physics(STEP)

    def _tell(self, told: list[Told], now: float, seconds: float) -> None:
        for one in told:
            if one.interval.due(seconds):
                self._send(one.topic, tell(one.machine, one.output, now))

    def _take(self, topic: str, message: bytes) -> None:
        for machine, one in self._heard.get(topic, []):
            try:
                take(machine, one, message, self.time, self._layout)
            except CdrError as error:
                self._trouble(topic, str(error))
            except IndexError:
                self._trouble(topic, "less values than names")


def _truth(machine: Machine) -> dict[str, Any]:
    base = machine.base
    joints = {
        name: {"position": drive.position, "velocity": drive.velocity, "target": drive.target}
        for name, drive in machine.joints.items()
        if drive is not None
    }
    tracks = {"left": machine.tracks.left.speed, "right": machine.tracks.right.speed}
    return {
        "joints": joints, "tracks": tracks, "place": [base.x, base.y, base.z], "yaw": base.yaw,
        "speed": machine.tracks.forward, "turning": machine.turning,
        "stopped": machine.stopped, "queued": machine.front.queued,
    }  # fmt: skip
