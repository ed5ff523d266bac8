"""The base of leaves that wait for an answer for which the C++ system waits inside the tick.

There the whole tree stands still until the answer comes. Here the leaf is RUNNING meanwhile; parents that start
over at every tick (ReactiveSequence, ReactiveFallback) recognise such a leaf by `asking` and go on where they were.
"""

from __future__ import annotations

from typing import Any, ClassVar

from tms_ts.bt.errors import TickError
from tms_ts.bt.leaf import PlainAction
from tms_ts.bt.status import FAILURE, RUNNING, Status
from tms_ts.tree_reasons import NoWorld, WaitsForAnswer
from tms_ts.world import Pending, World


class Asking(PlainAction):
    """An action that asks another process and returns once the answer is there."""

    __slots__ = ("pending",)
    asking: ClassVar[bool] = True

    def prepare(self) -> None:
        self.pending: Pending[Any] | None = None

    @property
    def world(self) -> World:
        if self.context.world is None:
            raise TickError(NoWorld(self.registration_name))
        return self.context.world

    def ask(self) -> Pending[Any] | None:
        """Put the question; None fails the node, with the reason set."""
        raise NotImplementedError

    def answered(self, value: Any) -> Status:
        raise NotImplementedError

    def tick(self) -> Status:
        if self.pending is None:
            self.reason = WaitsForAnswer()
            self.pending = self.ask()
            if self.pending is None:
                return FAILURE
        if not self.pending.done:
            return RUNNING
        pending, self.pending = self.pending, None
        if pending.error is not None:
            self.reason = pending.error
            return FAILURE
        self.reason = None
        return self.answered(pending.value)

    def halt(self) -> None:
        self.pending = None
