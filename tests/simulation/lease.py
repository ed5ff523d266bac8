"""Permits with leases, as DDS has them: a message for late comers, and reports of who is asserted and who is not."""

from collections.abc import Callable
from enum import Enum

from simulation.world import Process, World
from tms_decision.permit_link import LEASE, NOBODY

FORGET = 5.0  # s after which discovery drops a killed process
Heard = Callable[[bytes, str], None]
Reported = Callable[[int, int], None]


class Asserted(Enum):
    """A writer's liveliness."""

    NEVER = "not yet"
    ALIVE = "asserted"
    LAPSED = "its lease has lapsed"


class Topic:
    """The permits of one process on one machine: its present writer, and those of its predecessors."""

    def __init__(self, world: World, name: str) -> None:
        self.world, self.name = world, name
        self.writers: list[Writer] = []
        self.readers: dict[str, tuple[Heard, Reported]] = {}

    def join(self, name: str, heard: Heard, reported: Reported) -> None:
        """A reader finds the writers a moment later, or much later on a busy PC."""
        self.readers[name] = heard, reported
        late = self.world.random.choice((0.02, 0.05, 0.1, 0.3, 1.5))
        self.world.after(late, lambda: self._found(name))

    def _found(self, name: str) -> None:
        for writer in self.writers:
            writer.tell_again(name)
        self.report(name)

    def tell(self, name: str, goal: bytes, holder: str) -> None:
        """A reader receives a message."""
        heard, _ = self.readers[name]
        self.world.send(f"{self.name}/{name}", lambda: heard(goal, holder))

    def report(self, name: str) -> None:
        """A reader gets to know who is asserted."""
        _, reported = self.readers[name]
        alive = sum(writer.asserted is Asserted.ALIVE for writer in self.writers)
        not_alive = sum(writer.asserted is Asserted.LAPSED for writer in self.writers)
        self.world.send(f"{self.name}/{name}", lambda: reported(alive, not_alive))


class Writer:
    """The permit of one life of a process."""

    def __init__(self, topic: Topic, process: Process) -> None:
        self.topic, self.process, self.life = topic, process, process.life
        self.said: tuple[bytes, str] | None = None
        self.alive: Callable[[], bool] = lambda: True  # whether the process still does its work
        self.asserted = Asserted.NEVER
        topic.writers.append(self)

    @property
    def goal(self) -> bytes:
        return self.said[0] if self.said is not None else NOBODY

    def hold(self, goal: bytes, holder: str = "") -> None:
        """Stand behind a goal; NOBODY: behind none, and the assertions end."""
        self.said = goal, holder
        for name in self.topic.readers:
            self.topic.tell(name, goal, holder)
        if goal != NOBODY:
            self._is(Asserted.ALIVE)
        elif self.asserted is Asserted.ALIVE:
            self._lapses()

    def tell_again(self, name: str) -> None:
        """A reader has come late: it gets what was said last; of a process that is frozen, when that thaws."""
        if self.process.life == self.life:
            self.process.handle(lambda: self._tell(name))

    def _tell(self, name: str) -> None:
        if self.said is not None:
            self.topic.tell(name, *self.said)

    def frozen(self, seconds: float) -> None:
        """Its process is frozen: the lease lapses if that lasts."""
        if self.asserted is Asserted.ALIVE:
            self._lapses()
            self.topic.world.after(seconds + 0.01, self._back)

    def hangs(self, noticed: float, seconds: float) -> None:
        """What its process does hangs, which that notices after a while: then its assertions end."""
        self.topic.world.after(noticed, self._lapses)
        self.topic.world.after(seconds + 0.15, self._back)

    def killed(self) -> None:
        """Its process is killed; discovery drops it later."""
        if self.asserted is Asserted.ALIVE:
            self._lapses()
        self.topic.world.after(FORGET, self.left)

    def left(self) -> None:
        """It is no longer there."""
        if self in self.topic.writers:
            self.topic.writers.remove(self)
            self._report()

    def works(self) -> bool:
        """Whether its process is there and works."""
        return self.process.works() and self.process.life == self.life

    def _asserts(self) -> bool:
        return self.works() and self.goal != NOBODY and self.alive()

    def _lapses(self) -> None:
        world = self.topic.world
        world.after(LEASE - world.random.random() * 0.1, self._lapsed)  # asserted up to 0.1 s before

    def _lapsed(self) -> None:
        if not self._asserts() and self in self.topic.writers:
            self._is(Asserted.LAPSED)

    def _back(self) -> None:
        if self._asserts():
            self._is(Asserted.ALIVE)

    def _is(self, asserted: Asserted) -> None:
        if asserted is not self.asserted:
            self.asserted = asserted
            self._report()

    def _report(self) -> None:
        for name in self.topic.readers:
            self.topic.report(name)


class PermitProcess(Process):
    """A process with permits, whose leases lapse when it is killed or frozen."""

    def __init__(self, world: World, name: str, topics: dict[str, Topic]) -> None:
        super().__init__(world, name)
        self._topics = topics
        self.permits: dict[str, Writer] = {}  # by machine

    def begin(self) -> None:
        super().begin()
        self.permits = {machine: Writer(topic, self) for machine, topic in self._topics.items()}

    def kill(self) -> None:
        super().kill()
        for writer in self.permits.values():
            writer.killed()

    def end(self) -> None:
        """It ends in order."""
        super().kill()
        for writer in self.permits.values():
            writer.left()

    def freeze(self, seconds: float) -> None:
        if self.works():
            for writer in self.permits.values():
                writer.frozen(seconds)
        super().freeze(seconds)
