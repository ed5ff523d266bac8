"""The running stand-in: frames in real time, connection and control in between, all in one thread."""

import random
import select
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from operasim.connection import RETRY, Connection, Event
from operasim.control import Control, Refused
from operasim.messages import Layout
from operasim.model import Scene, Unknowns
from operasim.registration import LATE, Registration, registrations
from operasim.world import World

IDLE = 0.05  # s between looks at a connection while it is paused


@dataclass(frozen=True)
class Settings:
    """How it runs."""

    scene: Scene
    unknowns: Unknowns
    address: tuple[str, int]
    layout: Layout = "plain"
    rate: float = 60.0  # frames a second
    jitter: float = 0.3  # frames come earlier or later by this part of their time
    speed: float = 1.0  # simulated seconds a second
    seed: int = 0
    control: int | None = None  # port


class Simulator:
    """The application. A restart begins it anew, from time 0 and with a new connection."""

    def __init__(self, settings: Settings, event: Event) -> None:
        self._settings, self._event = settings, event
        self._chance = random.Random(settings.seed)
        self._speed, self._paused, self._ended = settings.speed, False, False
        self._troubles: set[tuple[str, str]] = set()
        self._begin(time.monotonic(), 0.0)
        self._control = Control(settings.control, self._command) if settings.control is not None else None
        if self._control is not None:
            event("control", port=self._control.port)

    def end(self) -> None:
        """Let `run` end; from any thread or signal handler."""
        self._ended = True

    def run(self) -> None:
        """Run until `end`."""
        while not self._ended:
            self._wait()
            now = time.monotonic()
            if self._paused or now < self._frame_at:
                continue
            self._frame(now)
        self._connection.close("the simulator ends", time.monotonic())
        if self._control is not None:
            self._control.close()

    def _begin(self, now: float, pause: float) -> None:
        """Load the scene; the connection begins after a pause [s]."""
        self._connection = Connection(self._settings.address, self._chance, self._event, now + pause)
        self._world = World(
            self._settings.scene, self._settings.unknowns, self._settings.layout, self._send, self._trouble
        )
        found = registrations(self._world.files, self._chance)
        self._frame_at = self._last = now + pause
        for one in found.first:
            self._connection.register(one)
        self._late: list[Registration] = found.late
        self._heard: set[str] = set()
        self._stopped: set[str] = set()

    def _wait(self) -> None:
        """Wait for the next frame, and serve sockets meanwhile."""
        left = IDLE if self._paused else min(max(self._frame_at - time.monotonic(), 0.0), IDLE)
        reading, writing = self._connection.waits_for()
        select.select(reading + (self._control.waits_for() if self._control is not None else []), writing, [], left)
        self._connection.work(time.monotonic())
        if self._control is not None:
            self._control.work()

    def _frame(self, now: float) -> None:
        """A frame: as much simulated time as has passed since the last one, up to a limit."""
        heard = self._connection.heard(now)
        self._world.frame((now - self._last) * self._speed, heard)
        self._log({topic for topic, _ in heard})
        if self._world.time >= LATE:
            for one in self._late:
                self._connection.register(one)
            self._late = []
        self._connection.work(now)
        self._last = now
        jitter = self._chance.uniform(-self._settings.jitter, self._settings.jitter)
        self._frame_at = now + (1 + jitter) / self._settings.rate

    def _log(self, topics: set[str]) -> None:
        """Tell of the first message of each topic, and of stops and releases."""
        for topic in sorted(topics - self._heard):
            self._event("hears", topic=topic)
        self._heard |= topics
        stopped = {name for name, one in self._world.machines.items() if one.stopped}
        for name in sorted(stopped ^ self._stopped):
            self._event(
                "emg_stop" if name in stopped else "released", machine=name, simulated=round(self._world.time, 3)
            )
        self._stopped = stopped

    def _send(self, topic: str, payload: bytes) -> None:
        self._connection.send(topic, payload)

    def _trouble(self, topic: str, why: str) -> None:
        """Tell of a message without effect, each once."""
        if (topic, why) not in self._troubles:
            self._troubles.add((topic, why))
            self._event("message_ignored", topic=topic, reason=why)

    # control

    def _command(self, words: Sequence[str]) -> dict[str, Any]:
        if not words or words[0] not in COMMANDS or len(words) > 2:
            raise Refused(f"commands: {', '.join(COMMANDS)}")
        try:
            value = float(words[1]) if len(words) > 1 else None
        except ValueError as error:
            raise Refused(f"{words[1]} is no number") from error
        if value is not None and not 0.0 <= value <= 1000.0:
            raise Refused(f"{words[1]} is not from 0 to 1000")
        COMMANDS[words[0]](self, value)
        return self.state()

    def state(self) -> dict[str, Any]:
        """What really is, as JSON."""
        how = {"connected": self._connection.connected, "paused": self._paused, "speed": self._speed}
        return how | self._world.truth()

    def pause(self, _value: float | None) -> None:
        """Stop frames; the connection is kept alive."""
        self._paused = True
        self._event("paused", simulated=round(self._world.time, 3))

    def resume(self, _value: float | None) -> None:
        """Go on with frames; the time of the pause is left out but for one long frame."""
        self._paused = False
        self._event("resumed", simulated=round(self._world.time, 3))

    def speed(self, value: float | None) -> None:
        """Let simulated time go this many times as fast; 0 stands still while frames go on."""
        self._speed = 1.0 if value is None else value
        self._event("speed", factor=self._speed)

    def cut(self, value: float | None) -> None:
        """Lose the connection for some seconds."""
        self._connection.close("cut", time.monotonic(), RETRY if value is None else value)

    def restart(self, value: float | None) -> None:
        """End the application and start it again after some seconds."""
        now = time.monotonic()
        self._connection.close("restart", now)
        self._event("restarted", simulated=round(self._world.time, 3))
        self._paused, self._speed = False, self._settings.speed
        self._begin(now, 1.0 if value is None else value)

    def tell(self, _value: float | None) -> None:
        """Change nothing; the state is the answer to all commands."""


COMMANDS: dict[str, Callable[[Simulator, float | None], None]] = {
    "state": Simulator.tell, "pause": Simulator.pause, "resume": Simulator.resume, "speed": Simulator.speed,
    "cut": Simulator.cut, "restart": Simulator.restart,
}  # fmt: skip
