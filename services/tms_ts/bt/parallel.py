"""Parallel: several children at a time, decided by thresholds in the middle of the round."""

from __future__ import annotations

from tms_reason.reason import Reason
from tms_ts.bt.control import Control
from tms_ts.bt.errors import TickError
from tms_ts.bt.node import AtOnce
from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, IDLE, RUNNING, SUCCESS, Status
from tms_ts.tree_reasons import Fail, FewChildren, Succeed


@node
class Parallel(Control):
    """Tick all children in every round until enough of them have succeeded or failed.

    success_threshold: so many successes end it; -1 means all
    failure_threshold: so many failures end it
    """

    __slots__ = ("done",)
    needs = ("success_threshold",)
    success_threshold: In[int]
    failure_threshold: In[int] = 1

    def prepare(self) -> None:
        self.done: set[int] = set()  # children that completed in this run

    def effective(self, threshold: int, end: Reason) -> int:
        count = len(self.children)
        value = threshold if threshold >= 0 else count + threshold + 1
        if not 0 <= value <= count:
            raise TickError(FewChildren(count, threshold, end))
        return value

    def tick(self) -> Status:
        need = self.effective(self.success_threshold, Succeed())
        allowed = self.effective(self.failure_threshold, Fail())
        successes = failures = 0
        for index, child in enumerate(self.children):
            status = child.state if index in self.done else child.execute_tick()
            if status is RUNNING:
                continue
            if status is IDLE:
                raise self.never_idle(child)
            self.done.add(index)
            if status is SUCCESS:
                successes += 1
                if successes == need:
                    return self.finish(SUCCESS)
            else:
                failures += 1
                if failures > len(self.children) - need or failures == allowed:
                    return self.finish(FAILURE)
        return RUNNING

    def finish(self, status: Status) -> Status:
        self.done.clear()
        self.reset_children()
        return status

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return any(succeeds for succeeds, _ in children), any(fails for _, fails in children)

    def halt(self) -> None:
        self.done.clear()
        self.reset_children()
