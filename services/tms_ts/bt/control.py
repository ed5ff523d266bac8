"""Control nodes with memory: Sequence, Fallback and SequenceStar, and the base of all control nodes."""

from __future__ import annotations

from typing import ClassVar

from tms_ts.bt.errors import TickError
from tms_ts.bt.node import AtOnce, Node
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, IDLE, RUNNING, SUCCESS, NodeType, Status
from tms_ts.tree_reasons import ChildIdle


class Control(Node):
    """A node over any number of children."""

    __slots__ = ()
    kind: ClassVar[NodeType] = NodeType.CONTROL

    def reset_children(self) -> None:
        for child in self.children:
            if child.state is not IDLE:
                child.reset()

    def halt(self) -> None:
        self.reset_children()

    def never_idle(self, child: Node) -> TickError:
        return TickError(ChildIdle(self.registration_name, child.name))


def in_order(children: list[AtOnce], goes_on: Status) -> AtOnce:
    """Whether a sequence (or, mirrored, a fallback) of children may succeed and may fail within one tick."""
    through, ended = True, False
    for succeeds, fails in children:
        on, off = (succeeds, fails) if goes_on is SUCCESS else (fails, succeeds)
        ended = ended or (through and off)
        through = through and on
    return (through, ended) if goes_on is SUCCESS else (ended, through)


class InOrder(Control):
    """Ticks its children one after the other and remembers where it is."""

    __slots__ = ("index",)
    goes_on: ClassVar[Status] = SUCCESS

    def prepare(self) -> None:
        self.index = 0

    def tick(self) -> Status:
        if self.state is not RUNNING:
            self.set_state(RUNNING)
        children = self.children
        while self.index < len(children):
            child = children[self.index]
            status = child.execute_tick()
            if status is RUNNING:
                return RUNNING
            if status is self.goes_on:
                self.index += 1
            elif status is IDLE:
                raise self.never_idle(child)
            else:
                return self.stop_early(status)
        self.reset_children()
        self.index = 0
        return self.goes_on

    def stop_early(self, status: Status) -> Status:
        self.reset_children()
        self.index = 0
        return status

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return in_order(children, self.goes_on)

    def halt(self) -> None:
        self.index = 0
        self.reset_children()


@node
class Sequence(InOrder):
    """Succeed when all children have succeeded, one after the other; fail with the first that fails."""

    __slots__ = ()


@node
class Fallback(InOrder):
    """Succeed with the first child that succeeds; fail when all have failed."""

    __slots__ = ()
    goes_on = FAILURE


@node
class SequenceStar(InOrder):
    """Like Sequence, but after a failure the next run goes on at the child that failed."""

    __slots__ = ()

    def stop_early(self, status: Status) -> Status:
        for child in self.children[self.index :]:
            child.reset()
        return status
