"""Delay and Timeout. They never sleep: the clock is read when the tree is ticked or polled."""

from __future__ import annotations

from tms_ts.bt.convert import UInt
from tms_ts.bt.decorator import Decorator
from tms_ts.bt.node import AtOnce
from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, IDLE, RUNNING, Status
from tms_ts.tree_reasons import Waits


class Timed(Decorator):
    """A decorator with a deadline."""

    __slots__ = ("deadline",)

    def prepare(self) -> None:
        self.deadline: float | None = None  # s, on the context's clock

    def arm(self, milliseconds: int) -> None:
        self.deadline = self.context.clock() + milliseconds / 1000
        self.context.timers.append(self)

    def disarm(self) -> None:
        if self.deadline is not None:
            self.deadline = None
            self.context.timers.remove(self)

    def expire(self) -> None:
        """Called when the deadline has passed, before the next tick."""


@node
class Delay(Timed):
    """Wait, then run the child.

    delay_msec: how long to wait, ms
    """

    __slots__ = ("over",)
    needs = ("delay_msec",)
    delay_msec: In[UInt]

    def prepare(self) -> None:
        super().prepare()
        self.over = False

    def expire(self) -> None:
        self.disarm()
        self.over = True

    def tick(self) -> Status:
        milliseconds = self.delay_msec
        if self.deadline is None and not self.over:
            self.arm(milliseconds)
            self.reason = Waits(milliseconds / 1000)
            return RUNNING
        if not self.over:
            return RUNNING
        self.reason = None
        status = self.child.execute_tick()
        if status is not RUNNING:
            self.over = False
            self.child.reset()
        return status

    def halt(self) -> None:
        self.disarm()
        self.over = False
        super().halt()

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return False, False


@node
class Timeout(Timed):
    """Fail, and halt the child, when the child takes too long.

    msec: how long the child may take, ms; 0 for ever
    """

    __slots__ = ("halted_child", "started")
    needs = ("msec",)
    msec: In[UInt]

    def prepare(self) -> None:
        super().prepare()
        self.started = self.halted_child = False

    def expire(self) -> None:
        self.disarm()
        if self.child.state is RUNNING:
            self.halted_child = True
            self.child.reset()

    def tick(self) -> Status:
        milliseconds = self.msec
        if not self.started:
            self.set_state(RUNNING)
            self.started, self.halted_child = True, False
            if milliseconds > 0:
                self.arm(milliseconds)
        if self.halted_child:
            self.started = self.halted_child = False
            return FAILURE
        status = self.child.execute_tick()
        if status not in (RUNNING, IDLE):
            self.disarm()
            self.started = False
            self.child.reset()
        return status

    def halt(self) -> None:
        if not self.context.quirks:  # the library forgets this: its old timer stays armed
            self.disarm()
            self.started = self.halted_child = False
        super().halt()
