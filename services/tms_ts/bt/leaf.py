"""Base classes for leaves. A leaf does no long work and never waits: it asks, and checks at the next tick."""

from __future__ import annotations

import inspect
from collections.abc import Generator
from typing import Any, ClassVar

from tms_ts.bt.convert import MISSING
from tms_ts.bt.errors import TickError
from tms_ts.bt.node import AtOnce, Node
from tms_ts.bt.ports import Pointer
from tms_ts.bt.status import FAILURE, IDLE, RUNNING, SUCCESS, NodeType, Status
from tms_ts.tree_reasons import ActionIdle, SyncRunning


class Leaf(Node):
    """A node without children."""

    __slots__ = ()
    kind: ClassVar[NodeType] = NodeType.ACTION


class PlainAction(Leaf):
    """An action whose `tick` is called every time; it brings its own `halt`."""

    __slots__ = ()

    def reported(self, port: str) -> str:
        """The text of a port in the document, also where it is a constant of a SubTreePlus.

        A value that is known only during the run is returned as its {key}.
        """
        bound: Any = self.bindings.get(port)
        if isinstance(bound, Pointer):
            value = self.blackboard.constant(bound.key)
            return value if isinstance(value, str) else "{" + bound.key + "}"
        text = self.ports[port].default if bound is None else bound
        return "" if text is MISSING else str(text)

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return True, True


class SyncAction(Leaf):
    """An action that is done when its `tick` returns; RUNNING is not allowed."""

    __slots__ = ()

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return True, True

    def execute_tick(self) -> Status:
        status = self.tick()
        self.set_state(status)
        if status is RUNNING:
            raise TickError(SyncRunning(self.registration_name))
        return status


class Condition(Leaf):
    """A question answered at once: `check` says yes or no."""

    __slots__ = ()
    kind: ClassVar[NodeType] = NodeType.CONDITION

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return True, True

    def check(self) -> bool:
        raise NotImplementedError

    def tick(self) -> Status:
        return SUCCESS if self.check() else FAILURE


class StatefulAction(Leaf):
    """An action over several ticks. Ticked when completed and not yet reset, it repeats its result and does nothing."""

    __slots__ = ()

    def on_start(self) -> Status:
        raise NotImplementedError

    def on_running(self) -> Status:
        raise NotImplementedError

    def on_halted(self) -> None:
        """Called when it is RUNNING and has to stop."""

    def tick(self) -> Status:
        state = self.state
        if state is RUNNING:
            status = self.on_running()
        elif state is IDLE:
            status = self.on_start()
        else:
            return state
        if status is IDLE:
            raise TickError(ActionIdle(self.registration_name))
        return status

    def halt(self) -> None:
        if self.state is RUNNING:
            self.on_halted()


class CoroAction(Leaf):
    """An action written as a generator: each `yield` is RUNNING, the returned status ends it."""

    __slots__ = ("_live",)

    def prepare(self) -> None:
        self._live: Generator[None, None, Status] | None = None

    def run(self) -> Generator[None, None, Status]:
        raise NotImplementedError

    def tick(self) -> Status:
        if (
            self._live is None
            or self.state is not RUNNING
            or inspect.getgeneratorstate(self._live) == inspect.GEN_CLOSED
        ):
            self._live = self.run()
        try:
            next(self._live)
        except StopIteration as end:
            self._live = None
            status: Status = end.value
            return status
        return RUNNING

    def halt(self) -> None:
        if self._live is not None:
            self._live.close()
            self._live = None
