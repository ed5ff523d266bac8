"""Ask the operator a yes-or-no question."""

from __future__ import annotations

from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, SUCCESS, Status
from tms_ts.bt.timers import Timeout
from tms_ts.nodes.asking import Asking
from tms_ts.tree_reasons import WaitsForOperator
from tms_ts.world import Pending


@node
class WaitForClick(Asking):
    """Wait for the operator: Yes succeeds, No fails.

    window_title: the title of the question
    button_info: the question
    """

    __slots__ = ()
    versions = (5, 6)
    window_title: In[str] = ""
    button_info: In[str] = ""

    def ask(self) -> Pending[bool]:
        title, text = self.window_title, self.button_info
        self.reason = WaitsForOperator(text or title)
        return self.world.clicks.ask(title, text, self.path, self._seconds())

    def _seconds(self) -> float | None:
        """How long the nearest Timeout above still waits."""
        above = self.parent
        while above is not None:
            if isinstance(above, Timeout) and above.deadline is not None:
                return max(0.0, above.deadline - self.context.clock())
            above = above.parent
        return None

    def answered(self, value: bool) -> Status:
        return SUCCESS if value else FAILURE

    def halt(self) -> None:
        if self.pending is not None:
            self.world.clicks.withdraw(self.pending)
        super().halt()
