"""Wait for a time."""

from __future__ import annotations

from tms_ts.bt.leaf import StatefulAction
from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import RUNNING, SUCCESS, Status
from tms_ts.tree_reasons import Waits


@node
class WaitTimer(StatefulAction):
    """Wait, then succeed; a halt ends the wait, and the next start begins a new one.

    seconds: how long to wait, s
    """

    __slots__ = ("until",)
    versions = (6,)
    seconds: In[float] = 1.0

    def prepare(self) -> None:
        self.until = 0.0  # s, on the context's clock

    def on_start(self) -> Status:
        seconds: float = self.seconds
        self.until = self.context.clock() + seconds
        self.reason = Waits(seconds)
        return RUNNING

    def on_running(self) -> Status:
        if self.context.clock() < self.until:
            return RUNNING
        self.reason = None
        return SUCCESS
