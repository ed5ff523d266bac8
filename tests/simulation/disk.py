"""What survives a crash: the notes of a gateway, and what the scheduler's PC has of runs."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from simulation.world import Violation, World
from tms_decision.gateway import effects as f
from tms_decision.gateway import events as e
from tms_decision.reasons import NoNote, SoftwareStop
from tms_reason.reason import Reason


@dataclass(frozen=True)
class Entry:
    """One event of a run, as its history has it."""

    kind: str
    node: str
    what: Reason


FULL = "No space left on device"
GROUP = 0.03  # s that lines wait for others
WRITTEN = 0.03  # s that some notes take, one after the other


@dataclass
class Notes:
    """The disk of a gateway. It may stall, or be full."""

    world: World
    armed: bool = False
    holder: str = ""
    run: int = 0
    cause: Reason | None = None
    driver: str = ""
    unproven: bool = False
    pressed: bool = False  # the host agent has renamed the note that says armed
    armed_at: float = 0.0
    latch_told: bool = False  # the gateway's last word was that the machine is latched
    rearming: bool = False  # a person has asked the gateway to arm it, and waits for the answer
    stalls: float = 0.0  # until then
    full: float = 0.0  # until then
    _done: float = 0.0  # when it has done what waits

    def left(self) -> e.Left:
        """How the machine was left."""
        latched = None if self.armed else (self.cause or NoNote())
        holder, run = (self.holder, self.run) if self.armed else ("", 0)
        return e.Left(latched, holder, run, self.driver, self.unproven and not self.armed)

    def keep(self, effect: f.KeepState | f.KeepDriver | f.KeepReceipt, life: Callable[[], bool],
             answer: Callable[[e.Event], None]) -> None:  # fmt: skip
        """Write after what waits already; a process that has ended by then has not written it."""
        world = self.world
        self._done = max(world.now, self._done, self.stalls) + 0.001 + world.random.random() * 0.01
        world.at(self._done, lambda: answer(self._written(effect)) if life() else None)

    def press(self, alive: Callable[[], bool]) -> None:
        """The host agent notes a press, unless it ends before."""
        begun = self.world.now

        def renamed() -> None:
            if alive() and self.armed and self.armed_at < begun:
                self.armed, self.cause, self.unproven, self.pressed = False, SoftwareStop(), True, True

        self.world.at(max(begun, self.stalls) + 0.01, renamed)

    def _written(self, effect: f.KeepState | f.KeepDriver | f.KeepReceipt) -> e.Event:
        full = self.world.now < self.full
        if isinstance(effect, f.KeepReceipt):
            self.unproven = self.unproven and full
            return e.ReceiptKept(effect.stop, FULL if full else "")
        problem = NoNote() if full else None
        if isinstance(effect, f.KeepDriver):
            self.driver = self.driver if full else effect.who
        elif effect.latched is not None:  # deleting a note works on a full disk
            self.armed, self.cause, self.unproven = False, None if full else effect.latched, True
            problem = None
        elif not full:
            self.armed, self.holder, self.run = True, effect.holder, effect.run
            self.pressed, self.armed_at = False, self.world.now
            self.latch_told = self.latch_told and not self.rearming  # also if the gateway ends before it can answer
        return e.NoteKept(effect.number, problem)


@dataclass
class RunDisk:
    """Checkpoints and journal on the scheduler's PC, written in groups: in each, checkpoints come first."""

    world: World
    checkpoints: dict[str, list[dict[str, Any]]] = field(default_factory=dict)
    journal: dict[tuple[str, int], Entry] = field(default_factory=dict)  # what the history has
    stalls: float = 0.0  # until then
    _waiting: list[Callable[[], None]] = field(default_factory=list)
    _last: list[Callable[[], None]] = field(default_factory=list)  # after those: the journal, and what follows
    _life: int = 0

    def line(self, run: str, line: dict[str, Any], urgent: bool = False) -> None:
        """Add a line to a checkpoint."""
        stamped = {**line, "t": 1e9 + self.world.now}
        self._put(self._waiting, lambda: self.checkpoints.setdefault(run, []).append(stamped), urgent)

    def tell(self, run: str, number: int, entry: Entry) -> None:
        """Add an entry to the journal, which has each number once."""

        def write() -> None:
            before = self.journal.setdefault((run, number), entry)
            if before != entry:
                raise Violation(f"event {number} of {run} is told twice: {before}, {entry}")

        self._put(self._last, write)

    def forget(self, run: str) -> None:
        """Remove a checkpoint, after everything so far is on the disk."""
        self._put(self._last, lambda: self._removed(run))

    def _removed(self, run: str) -> None:
        self.checkpoints.pop(run, None)

    def after(self, step: Callable[[], None]) -> None:
        """Do a step when everything so far is on the disk."""
        self._put(self._last, step)

    def killed(self) -> None:
        """The writing process ends: what waits is lost, or in part, if it is being written."""
        steps = [*self._waiting, *self._last]
        for step in steps[: self.world.random.randint(0, len(steps)) if self.world.random.random() < 0.5 else 0]:
            step()
        self._waiting, self._last = [], []
        self._life += 1

    def _put(self, queue: list[Callable[[], None]], step: Callable[[], None], urgent: bool = False) -> None:
        first = not (self._waiting or self._last)
        queue.append(step)
        if first or urgent:
            wait = 0.002 if urgent else GROUP
            life, random = self._life, self.world.random
            when = max(self.world.now + wait, self.stalls) + 0.01 * random.random()
            self.world.at(when, lambda: self._write() if life == self._life else None)

    def _write(self) -> None:
        steps, self._waiting, self._last = [*self._waiting, *self._last], [], []
        for step in steps:
            step()
