"""Repeat and RetryUntilSuccessful: they loop inside one tick, as long as the child completes at once.

The library never leaves the tick when an endless loop has only such children; here the loop yields RUNNING after a
budget of rounds (context.py) and goes on at the next tick, so that a stop always gets through.
"""

from __future__ import annotations

from typing import ClassVar

from tms_ts.bt.convert import text_to_int
from tms_ts.bt.decorator import Decorator
from tms_ts.bt.node import AtOnce, Node
from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, IDLE, RUNNING, SUCCESS, Status
from tms_ts.tree_reasons import LoopedInTick


class Loop(Decorator):
    """Runs its child again and again."""

    __slots__ = ("asks", "count")
    goes_on: ClassVar[Status] = SUCCESS
    limit_port: ClassVar[str] = ""

    def prepare(self) -> None:
        self.count = 0
        self.asks: bool | None = None  # whether a node below reads or writes shared values

    def tick(self) -> Status:
        limit: int = self.require(self.limit_port)
        self.set_state(RUNNING)
        rounds = 0
        while limit == -1 or self.count < limit:
            if rounds and not (self.context.may_loop(rounds, endless=limit == -1) and self.may_ask(limit)):
                self.reason = LoopedInTick(rounds)
                return RUNNING
            rounds += 1
            status = self.child.execute_tick()
            if status is RUNNING:
                return RUNNING
            if status is IDLE:
                raise self.never_idle()
            self.child.reset()
            if status is not self.goes_on:
                self.count = 0
                return status
            self.count += 1
        self.count = 0
        return self.goes_on

    def halt(self) -> None:
        self.count = 0
        super().halt()

    def may_ask(self, limit: int) -> bool:
        """Whether another round in this tick can differ: the known shared values are the same in each round."""
        if self.asks is None:
            self.asks = _asks(self.child)
        return limit != -1 or not self.asks

    def endless(self) -> bool:
        text = self.literal(self.limit_port)
        return text is not None and text_to_int(text) == -1

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        succeeds, fails = children[0]
        if not self.endless():
            return succeeds, fails
        return (False, fails) if self.goes_on is SUCCESS else (succeeds, False)

    def may_hang(self, children: list[AtOnce]) -> bool:
        return self.endless() and children[0][0 if self.goes_on is SUCCESS else 1]


def _asks(node: Node) -> bool:
    return node.asking or any(map(_asks, node.children))


@node
class Repeat(Loop):
    """Run the child several times; fail when it fails.

    num_cycles: how many times; -1 for ever
    """

    __slots__ = ()
    limit_port = "num_cycles"
    needs = ("num_cycles",)
    num_cycles: In[int]


@node
class RetryUntilSuccessful(Loop):
    """Run the child until it succeeds; fail when all attempts have failed.

    num_attempts: how many attempts; -1 for ever
    """

    __slots__ = ()
    goes_on = FAILURE
    limit_port = "num_attempts"
    needs = ("num_attempts",)
    num_attempts: In[int]
