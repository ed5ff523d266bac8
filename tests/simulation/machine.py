"""A machine with its server, in a site: commands come by messages."""

from collections.abc import Callable

from simulation.plant import PERIOD, Plant
from simulation.world import World
from tms_proof.source import SourceSample

SPEED = 0.3  # rad/s of every goal


class Machine:
    """Its server takes one goal at a time."""

    def __init__(self, world: World, name: str, at_once: bool, passive: bool = False) -> None:
        self.world, self.name, self.plant = world, name, Plant(at_once, passive)
        self.hears: dict[str, Callable[[SourceSample], None]] = {}  # who receives what it tells
        self.presses: dict[str, Callable[[], None]] = {}  # who sees that its emergency stop is pressed
        self.clock = 1e9  # s, of its stamps, less virtual time
        self.ordered_to_stop = 0.0  # when it last received an order to stop
        self.succeeded: set[int] = set()  # goals that it has done to their end
        self.watched: Callable[[int, str], None] = lambda goal, word: None  # `accepted`, or how it has ended
        self._open: dict[int, Callable[[str], None]] = {}
        world.after(PERIOD, self._beat)

    def _beat(self) -> None:
        now = self.world.now
        self._tell(self.plant.tell(now, self.clock))
        self._tell(self.plant.other(now, self.clock))
        done = self.plant.done(now)
        if done is not None:
            self.succeeded.add(done)
            self._ends(done, "SUCCEEDED")
        self.world.after(PERIOD, self._beat)

    def _tell(self, sample: SourceSample | None) -> None:
        if sample is not None:
            for name, hear in list(self.hears.items()):
                self.world.send(f"{name} telemetry", lambda hear=hear: hear(sample))  # type: ignore[misc]

    def zero(self) -> None:
        self._halt(False, "ABORTED")

    def cancel(self) -> None:
        self._halt(False, "CANCELED")

    def emergency(self, on: bool) -> None:
        self.plant.emergency = on and not self.plant.fault.ignore_emergency
        if on:
            self._halt(True, "ABORTED")
            for name, pressed in list(self.presses.items()):
                self.world.send(f"{name} pressed", pressed)

    def _halt(self, pressed: bool, outcome: str) -> None:
        self.ordered_to_stop = self.world.now
        self._ends(self.plant.halt(self.world.now, pressed), outcome)

    def send(self, goal: int, seconds: float, answer: Callable[[str], None]) -> None:
        """A goal arrives; `answer` is called with `accepted`, and with its outcome."""
        if self.plant.fault.silent_server:
            return
        if not self.plant.accept(goal, seconds, SPEED, self.world.now):
            answer("REJECTED")
            return
        self._open[goal] = answer
        self.world.tell(self.name, f"accepts goal {goal} for {seconds:.1f} s")
        self.watched(goal, "accepted")
        answer("accepted")

    def _ends(self, goal: int | None, outcome: str) -> None:
        if goal is not None and goal in self._open:
            self.world.tell(self.name, f"goal {goal} ends: {outcome}")
            self.watched(goal, outcome)
            self._open.pop(goal)(outcome)
