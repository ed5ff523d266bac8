"""Virtual time, a network and processes: the same seed gives the same history."""

import heapq
import random
from collections.abc import Callable
from dataclasses import dataclass, field

from mypy_extensions import mypyc_attr

Step = Callable[[], None]


@dataclass(frozen=True)
class Happened:
    """One line of a history."""

    at: float  # s of virtual time
    who: str
    what: str

    def __str__(self) -> str:
        return f"{self.at:9.3f}  {self.who:16} {self.what}"


@mypyc_attr(native_class=False)  # an exception stays one of Python's when it is compiled (compiled.py)
class Violation(AssertionError):
    """An invariant does not hold."""


class World:
    """Events in order of time; all chance comes from `random`."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.now = 0.0
        self.history: list[Happened] = []
        self.events = 0
        self._waiting: list[tuple[float, int, Step]] = []
        self._number = 0
        self._lanes: dict[str, float] = {}  # when the last message of a topic arrives

    def at(self, when: float, step: Step) -> None:
        """Do a step at a time."""
        self._number += 1
        heapq.heappush(self._waiting, (when if when > self.now else self.now, self._number, step))

    def after(self, seconds: float, step: Step) -> None:
        """Do a step later."""
        self.at(self.now + seconds, step)

    def send(self, topic: str, step: Step, slow: float = 0.0) -> None:
        """A message on its way: those of one topic stay in order, those of others may overtake it."""
        chance = self.random.random
        delay = self.random.expovariate(1 / 0.003) + 0.001 + (chance() < 0.02) * chance() * 0.2
        arrives = max(self.now + delay + slow, self._lanes.get(topic, 0.0) + 1e-6)
        self._lanes[topic] = arrives
        self.at(arrives, step)

    def run(self, until: float) -> None:
        """Let events happen."""
        waiting = self._waiting
        while waiting and waiting[0][0] <= until:
            self.now, _, step = heapq.heappop(waiting)
            self.events += 1
            step()
        self.now = until

    def tell(self, who: str, what: str) -> None:
        """Add a line to the history."""
        self.history.append(Happened(self.now, who, what))


@dataclass
class Process:
    """A process that may be killed, frozen and started again; what comes meanwhile is lost, or waits."""

    world: World
    name: str
    alive: bool = False
    life: int = 0  # how often it was started
    thaws: float = 0.0  # frozen until then
    waiting: list[Step] = field(default_factory=list)
    lost_at: float = 0.0  # when it was killed or frozen last
    up_at: float = 0.0  # when it began to work last
    begun_at: float = 0.0  # when its life began

    def frozen(self) -> bool:
        return self.world.now < self.thaws

    def lost_for(self) -> float:
        """Seconds for which it does not work; 0 while it does."""
        return 0.0 if self.alive and not self.frozen() else self.world.now - self.lost_at

    def worked_for(self) -> float:
        """Seconds for which it works without a break; 0 while it does not."""
        return self.world.now - self.up_at if self.alive and not self.frozen() else 0.0

    def handle(self, step: Step) -> None:
        """Do a step in this process: now, or when it thaws; never in a later life."""
        if not self.alive:
            return
        if self.world.now < self.thaws:
            self.waiting.append(step)
        else:
            step()

    def later(self, seconds: float, step: Step) -> None:
        """A timer of the process; it ends with it."""
        life = self.life
        self.world.after(seconds, lambda: self.handle(step) if self.life == life else None)

    def in_life(self, step: Callable[..., None]) -> Callable[..., None]:
        """A step of this life: what comes for it later, or while it is frozen, waits or is lost."""
        life = self.life
        return lambda *words: self.handle(lambda: step(*words)) if self.life == life else None

    def start(self) -> None:
        """Start it anew."""
        self.begin()

    def begin(self) -> None:
        self.alive, self.thaws, self.waiting = True, 0.0, []
        self.life += 1
        self.up_at = self.begun_at = self.world.now
        self.world.tell(self.name, f"starts ({self.life})")

    def kill(self) -> None:
        """Kill it; the caller starts it again."""
        self.alive, self.waiting = False, []
        self.lost_at = self.world.now
        self.world.tell(self.name, "is killed")

    def works(self) -> bool:
        return self.alive and not self.frozen()

    def freeze(self, seconds: float) -> None:
        """Freeze it for a while."""
        if not self.alive or self.frozen():
            return
        self.world.tell(self.name, f"is frozen for {seconds:.2f} s")
        self.thaws, self.lost_at = self.world.now + seconds, self.world.now
        self.world.at(self.thaws, self._thaw)

    def _thaw(self) -> None:
        if self.alive and not self.frozen():
            self.up_at = self.world.now
            steps, self.waiting = self.waiting, []
            for step in steps:
                self.handle(step)  # one of them may be its end
