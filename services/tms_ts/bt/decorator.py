"""Decorators: nodes with one child, whose result they change."""

from __future__ import annotations

from typing import ClassVar

from tms_ts.bt.errors import TickError
from tms_ts.bt.node import AtOnce, Node
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, IDLE, RUNNING, SUCCESS, NodeType, Status
from tms_ts.tree_reasons import ChildIdle


class Decorator(Node):
    """A node over exactly one child."""

    __slots__ = ()
    kind: ClassVar[NodeType] = NodeType.DECORATOR

    @property
    def child(self) -> Node:
        return self.children[0]

    def execute_tick(self) -> Status:
        status = self.tick()
        if status is not self.state:
            self.set_state(status)
        child = self.children[0]
        if child.state >= 2:
            child.set_state(IDLE)
        return status

    def halt(self) -> None:
        child = self.children[0]
        if child.state is not IDLE:
            child.reset()

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return children[0]

    def never_idle(self) -> TickError:
        return TickError(ChildIdle(self.registration_name, self.child.name))


@node
class Inverter(Decorator):
    """Success becomes failure, failure becomes success."""

    __slots__ = ()

    def tick(self) -> Status:
        self.set_state(RUNNING)
        status = self.child.execute_tick()
        if status is RUNNING:
            return RUNNING
        if status is IDLE:
            raise self.never_idle()
        self.child.reset()
        return FAILURE if status is SUCCESS else SUCCESS

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        succeeds, fails = children[0]
        return fails, succeeds


class Force(Decorator):
    """Returns one result, whatever its child returns."""

    __slots__ = ()
    result: ClassVar[Status] = SUCCESS

    def tick(self) -> Status:
        self.set_state(RUNNING)
        status = self.child.execute_tick()
        if not status.completed:
            return status
        self.child.reset()
        return self.result

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        completes = any(children[0])
        return completes and self.result is SUCCESS, completes and self.result is FAILURE


@node
class ForceSuccess(Force):
    """Succeed however the child ends."""

    __slots__ = ()


@node
class ForceFailure(Force):
    """Fail however the child ends."""

    __slots__ = ()
    result = FAILURE


@node
class KeepRunningUntilFailure(Decorator):
    """Run the child again and again until it fails."""

    __slots__ = ()

    def tick(self) -> Status:
        self.set_state(RUNNING)
        status = self.child.execute_tick()
        if status.completed:
            self.child.reset()
        return FAILURE if status is FAILURE else RUNNING

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return False, children[0][1]
