"""Whether the executor of a process still runs: its health port tells, and the host agent restarts one that hangs."""

from tms_config.clock import monotonic
from tms_reason.reason import Reason
from tms_ros.node import Ros
from tms_runtime.reasons import Hangs

HANGS = 5.0  # s after which an executor that does not run counts as hanging


class Hanging:
    """Looks at the executor of one node."""

    def __init__(self, ros: Ros) -> None:
        self._ros = ros
        self._asked: float | None = None  # monotonic time since which the executor has not shown itself

    def check(self) -> Reason | None:
        """Asks the executor to show itself; why it should be restarted when it has not done so since it was asked."""
        asked = self._asked
        if asked is not None:
            seconds = monotonic() - asked
            return Hangs(self._ros.process, seconds) if seconds > HANGS else None
        self._asked = monotonic()
        self._ros.on_executor(self._shown)
        return None

    def _shown(self) -> None:
        self._asked = None
