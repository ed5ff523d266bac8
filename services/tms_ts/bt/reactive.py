"""Control nodes without memory: every tick begins at the first child again."""

from __future__ import annotations

from typing import ClassVar

from tms_ts.bt.control import Control, in_order
from tms_ts.bt.node import AtOnce
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, IDLE, RUNNING, SUCCESS, Status


class Reactive(Control):
    """A RUNNING child halts and resets every other child, those before it as well.

    One that only waits for an answer (`Node.asking`) does not: in the library it would have blocked the tick, so the
    round goes on at that child with the next tick, and a machine that moves meanwhile is not halted.
    """

    __slots__ = ("waiting_at",)
    goes_on: ClassVar[Status] = SUCCESS

    def prepare(self) -> None:
        self.waiting_at = 0

    def tick(self) -> Status:
        self.set_state(RUNNING)
        first, self.waiting_at = self.waiting_at, 0
        for index in range(first, len(self.children)):
            child = self.children[index]
            status = child.execute_tick()
            if status is RUNNING:
                self.keep_only(index)
                return RUNNING
            if status is IDLE:
                raise self.never_idle(child)
            if status is not self.goes_on:
                self.reset_children()
                return status
        self.reset_children()
        return self.goes_on

    def keep_only(self, index: int) -> None:
        if self.children[index].only_asks():
            self.waiting_at = index
            return
        for position, other in enumerate(self.children):
            if position != index and other.state is not IDLE:
                other.reset()

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return in_order(children, self.goes_on)

    def halt(self) -> None:
        self.waiting_at = 0
        self.reset_children()


@node
class ReactiveSequence(Reactive):
    """Tick all children anew each time: earlier ones act as conditions that guard the later ones."""

    __slots__ = ()


@node
class ReactiveFallback(Reactive):
    """Tick children anew each time until one succeeds; an earlier success halts a later RUNNING child."""

    __slots__ = ()
    goes_on = FAILURE
