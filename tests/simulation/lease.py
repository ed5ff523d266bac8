"""Permits with leases, as DDS has them: a message for late comers, and reports of who is asserted."""

from collections.abc import Callable

from simulation.world import Process, World
from tms_decision.permit_link import LEASE, NOBODY

FORGET = 5.0  # s after which discovery drops a killed process
Heard = Callable[[bytes, str], None]
Reported = Callable[[int, int], None]


class Permit:
    """The permit of one process on one machine; readers join at any time."""

    def __init__(self, world: World, topic: str, owner: Process) -> None:
        self.goal, self.holder = NOBODY, ""
        self._world, self._topic, self._owner = world, topic, owner
        self._readers: dict[str, tuple[Heard, Reported]] = {}
        self._alive = False  # as DDS sees it
        self._stale = 0  # killed writers that discovery has not dropped

    def join(self, name: str, heard: Heard, reported: Reported) -> None:
        """A reader finds the writer a moment later, or much later on a busy PC."""
        self._readers[name] = heard, reported
        late = self._world.random.choice((0.02, 0.05, 0.1, 0.3))
        self._world.after(late, lambda: self._tell(name) if self._owner.alive else None)

    def hold(self, goal: bytes, holder: str) -> None:
        """Stand behind a goal; NOBODY: behind none."""
        self.goal, self.holder = goal, holder
        self._alive = goal != NOBODY
        for name in self._readers:
            self._tell(name)

    def frozen(self, seconds: float) -> None:
        """Its process is frozen: the lease lapses if that lasts."""
        lapse = self._lapse()
        if self._alive and seconds > lapse:
            self._world.after(lapse, self._lapsed)
            self._world.after(seconds + 0.01, self._back)

    def killed(self) -> None:
        """Its process is killed."""
        if self._alive:
            self._stale += 1
            self._world.after(self._lapse(), self._lapsed)
            self._world.after(FORGET, self._dropped)
        self.goal, self.holder = NOBODY, ""

    def _lapse(self) -> float:
        return LEASE - self._world.random.random() * 0.1  # the last assertion was up to 0.1 s before

    def _lapsed(self) -> None:
        if self._owner.alive and not self._owner.frozen() and self.goal != NOBODY:
            return  # a successor asserts it
        self._alive = False
        self._report()

    def _back(self) -> None:
        if self._owner.alive and not self._owner.frozen() and self.goal != NOBODY:
            self._alive = True
            self._report()

    def _dropped(self) -> None:
        self._stale -= 1
        self._report()

    def _report(self) -> None:
        for _, reported in self._readers.values():
            self._world.send(f"{self._topic}/lease", lambda reported=reported: reported(int(self._alive), self._stale))  # type: ignore[misc]

    def _tell(self, name: str) -> None:
        heard, reported = self._readers[name]
        goal, holder, alive, stale = self.goal, self.holder, self._alive, self._stale
        if goal != NOBODY or alive:
            self._world.send(f"{self._topic}/{name}", lambda: heard(goal, holder))
            self._world.send(f"{self._topic}/{name}/lease", lambda: reported(int(alive), stale))
        else:
            self._world.send(f"{self._topic}/{name}", lambda: heard(goal, holder))
