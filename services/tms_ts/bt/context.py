"""What the nodes of one tree share: clock, world, observers, timers and the work allowed in one tick."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, Protocol, TypeVar

from tms_config.clock import monotonic
from tms_reason.reason import Reason
from tms_ts.bt.errors import MAX_WARNINGS, shortened
from tms_ts.bt.status import Status
from tms_ts.world import World

N = TypeVar("N")  # the nodes that observers are called with

ENDLESS_ROUNDS = 100  # rounds that one endless loop may make in a tick
ALL_ROUNDS = 10_000  # rounds of all loops of the tree together in a tick
TICK_SECONDS = 0.02  # a loop that finds the tick older than this yields


class Timer(Protocol):
    """A node that waits until a time."""

    deadline: float | None

    def expire(self) -> None: ...


class Context(Generic[N]):
    """What the nodes of one tree share: its clock, its timers, its budget of a tick, and its observers."""

    __slots__ = (
        "_reported",
        "_rounds_left",
        "_yield_at",
        "clock",
        "faults",
        "observers",
        "quirks",
        "timers",
        "warnings",
        "world",
    )

    def __init__(self, world: World | None, clock: Callable[[], float] | None = None, *, quirks: bool = False) -> None:
        self.world = world
        self.clock = clock or (world.clock if world else monotonic)
        self.quirks = quirks
        self.observers: list[Callable[[N, Status, Status], None]] = []
        self.timers: list[Timer] = []  # armed ones
        self.warnings: list[tuple[int, Reason]] = []
        self.faults: list[tuple[int, str, Reason]] = []  # line, path: nodes that throw whenever they are ticked
        self._reported: set[tuple[int, Reason]] = set()
        self._rounds_left = ALL_ROUNDS
        self._yield_at = float("inf")

    def begin_tick(self) -> None:
        self._rounds_left = ALL_ROUNDS
        self._yield_at = self.clock() + TICK_SECONDS

    def may_loop(self, rounds: int, *, endless: bool) -> bool:
        """Whether a loop that has made `rounds` rounds in this tick may make another one in it."""
        self._rounds_left -= 1
        if endless and rounds >= ENDLESS_ROUNDS:
            return False
        return self._rounds_left > 0 and self.clock() < self._yield_at

    def warn(self, line: int, what: Reason) -> None:
        note = (line, shortened(what))
        if note not in self._reported and len(self.warnings) < MAX_WARNINGS:
            self._reported.add(note)
            self.warnings.append(note)
