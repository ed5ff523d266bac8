"""Our stand-in of OperaSim-PhysX in the drill: the true motion of its machines, and its own troubles."""

import json
import re
import socket
import threading
from collections import defaultdict, deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from tms_cli.drill.plan import How
from tms_cli.drill.record import MotionSample
from tms_cli.reasons import NoControlPort
from tms_config.clock import monotonic, sleep, unix_time
from tms_config.models import Still
from tms_reason.errors import TmsError

CONTROL = re.compile(r"event=control port=(\d+)")
START_LIMIT, ANSWER_LIMIT, BACK_LIMIT = 20.0, 5.0, 40.0  # s
PERIOD = 0.04  # s between samples, as the stand-ins of our own tell them
WAITING = 250  # samples of a machine, ten seconds
CHECK_PERIOD = 0.1  # s
CUT, PAUSE, RESTART = 2.0, 1.5, 1.0  # s of the troubles


@dataclass(frozen=True)
class Told:
    """What the simulator has told of a machine."""

    at: float  # s since 1970
    time: float  # s of the simulator
    machine: Mapping[str, Any]


class ControlPort:
    """A client of the control port: a command is a line, its answer a line of JSON."""

    def __init__(self, port: int, limit: float) -> None:
        """`limit`: s for each answer. It raises OSError where nothing listens or answers."""
        self._socket = socket.create_connection(("127.0.0.1", port), timeout=limit)
        self._answers = self._socket.makefile("r", encoding="utf-8")

    def command(self, line: str) -> dict[str, Any]:
        """Send a command; returns the state of the simulator."""
        self._socket.sendall(line.encode() + b"\n")
        answer = json.loads(self._answers.readline())
        return dict(answer)

    def close(self) -> None:
        """End the connection."""
        self._answers.close()
        self._socket.close()


class OperaSim:
    """Samples all machines in a thread of its own."""

    def __init__(self, log: Path) -> None:
        """`log`: of the simulator, which names its port there.

        Raises:
            TmsError: it names none in time.
        """
        port = _port(log)
        self._hand, self._eye = ControlPort(port, ANSWER_LIMIT), ControlPort(port, ANSWER_LIMIT)
        self._samples: dict[str, deque[Told]] = defaultdict(lambda: deque(maxlen=WAITING))
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._sample, name="truth", daemon=True)
        self._thread.start()

    def truth(self, machine: str, still: Still) -> Callable[[], list[MotionSample]]:
        """A function that takes the samples since its last call."""
        waiting = self._samples[machine]
        last: list[Told] = []

        def take() -> list[MotionSample]:
            new = [*last, *(waiting.popleft() for _ in range(len(waiting)))]
            last[:] = new[-1:]
            return [sample_of(after, still, paused=after.time <= before.time) for before, after in pairwise(new)]

        return take

    def trouble(self, how: How) -> float:
        """Lose the connection, pause or restart the simulator, until it works again; returns s since the beginning.

        Raises:
            TmsError: it does not come back.
        """
        begun = monotonic()
        self._hand.command({How.CUT: f"cut {CUT}", How.PAUSE: "pause", How.RESTART: f"restart {RESTART}"}[how])
        if how is How.PAUSE:
            sleep(PAUSE)
            self._hand.command("resume")
        while not self._hand.command("state")["connected"]:
            if monotonic() - begun > BACK_LIMIT:
                raise TmsError(NoControlPort("operasim"))
            sleep(CHECK_PERIOD)
        return monotonic() - begun

    def close(self) -> None:
        """End the thread and both connections."""
        self._closing.set()
        self._thread.join()
        self._hand.close()
        self._eye.close()

    def _sample(self) -> None:
        while not self._closing.wait(PERIOD):
            try:
                state = self._eye.command("state")
            except (OSError, ValueError):
                return  # it has ended; the drill looks after its children
            for name, machine in state["machines"].items():
                self._samples[name].append(Told(unix_time(), float(state["time"]), machine))


def _port(log: Path) -> int:
    deadline = monotonic() + START_LIMIT
    while not (found := CONTROL.findall(log.read_text(encoding="utf-8", errors="replace"))):
        if monotonic() > deadline:
            raise TmsError(NoControlPort(str(log)))
        sleep(CHECK_PERIOD)
    return int(found[-1])


def sample_of(told: Told, still: Still, paused: bool) -> MotionSample:
    """The true motion; `paused`: the time of the simulator stands still, or it has begun anew."""
    machine = told.machine
    joints = {name: float(joint["position"]) for name, joint in machine["joints"].items()}
    (x, y, *_), angles = machine["place"], {**joints, "heading": float(machine["yaw"])}
    joint = max((abs(float(joint["velocity"])) for joint in machine["joints"].values()), default=0.0)
    way, turn = abs(machine["speed"]) / still.linear, abs(machine["turning"]) / still.angular
    return MotionSample(told.at, 0.0 if paused else max(joint / still.velocity, way, turn), angles, (x, y))
