"""The true motion of the machine, from the control port of the simulator's stand-in."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tms_cli.drill.operasim import ControlPort

PERIOD = 0.05  # s between samples
LIMIT = 20.0  # s for an answer
MOVING, STILL = 0.05, 0.01  # rad/s: above the one a joint surely moves, below the other it stands
JOINTS = ("swing_joint", "boom_joint", "arm_joint", "bucket_joint")


@dataclass(frozen=True)
class Sample:
    """Joints at a moment: s since 1970, rad, rad/s."""

    at: float
    positions: dict[str, float]
    velocities: dict[str, float]

    @property
    def speed(self) -> float:
        """Of the fastest joint [rad/s]."""
        return max(abs(velocity) for velocity in self.velocities.values())


class Truth:
    """Samples of one machine, taken by a thread until the end."""

    def __init__(self, port: int, machine: str) -> None:
        self._client = ControlPort(port, LIMIT)
        self._machine = machine
        self.samples: list[Sample] = []
        self._added, self._closing = threading.Condition(), threading.Event()
        self._thread = threading.Thread(target=self._sample, name="truth", daemon=True)
        self._thread.start()

    def wait(self, holds: Callable[[Sample], bool], seconds: float) -> bool:
        """Until a new sample is so; False when the time is over."""
        with self._added:
            return self._added.wait_for(lambda: bool(self.samples) and holds(self.samples[-1]), seconds)

    def since(self, at: float) -> list[Sample]:
        return [sample for sample in self.samples if sample.at >= at]

    def close(self) -> None:
        self._closing.set()
        self._thread.join()
        self._client.close()

    def _sample(self) -> None:
        while not self._closing.wait(PERIOD):
            joints = self._client.command("state")["machines"][self._machine]["joints"]
            positions, velocities = (
                {name: float(joints[name][key]) for name in JOINTS} for key in ("position", "velocity")
            )
            with self._added:
                self.samples.append(Sample(time.time(), positions, velocities))
                self._added.notify_all()


def travel(samples: Sequence[Sample]) -> float:
    """The way of the joint that went furthest from where it was at first [rad]."""
    first = samples[0].positions
    return max(abs(sample.positions[name] - first[name]) for sample in samples for name in JOINTS)


def stood(samples: Sequence[Sample]) -> float | None:
    """When the last motion of these samples was over [s since 1970]; None if the machine moves at their end."""
    if not samples or samples[-1].speed > STILL:
        return None
    at = samples[-1].at
    for sample in reversed(samples):
        if sample.speed > STILL:
            return at
        at = sample.at
    return at
