"""Checks whether a process's executor still runs: the health port reports it, the host agent restarts the process."""

from tms_config.clock import monotonic
from tms_reason.reason import Reason
from tms_ros.node import Ros
from tms_runtime.reasons import Hangs

HANGS = 5.0  # s after which an executor that does not run counts as hanging


class Hanging:
    """Checks the executor of one node."""

    def __init__(self, ros: Ros) -> None:
        self._ros = ros
        self._asked: float | None = None  # monotonic time of the request that the executor has not answered

    def check(self) -> Reason | None:
        """Ask the executor for an answer; returns why it must be restarted if it has not answered the last request."""
        asked = self._asked
        if asked is not None:
            seconds = monotonic() - asked
            return Hangs(self._ros.process, seconds) if seconds > HANGS else None
        self._asked = monotonic()
        self._ros.on_executor(self._shown)
        return None

    def _shown(self) -> None:
        self._asked = None
