"""What else than its motion a gateway watches, as others use it, and as people are told."""

from collections.abc import Sequence
from typing import Protocol

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from tms_config.clock import monotonic
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_runtime.app import App

LOOK = 0.1  # s between looks for a change
PERIOD = 0.5  # s between messages without one


class Watch(Protocol):
    """Looks for what forbids motions. No answer waits."""

    def unready(self, drives: bool) -> Reason | None:
        """Why nothing may begin to move; `drives`: by its tracks."""

    def astray(self) -> Reason | None:
        """Why what moves must stop; a loss, if that may pass by itself."""

    def report(self) -> DiagnosticStatus:
        """What people are told."""


def status(name: str, forbids: Reason | None, warns: Reason | None = None) -> DiagnosticStatus:
    """A report: what forbids motions is an error; its message is a reason's line."""
    level = DiagnosticStatus.ERROR if forbids else DiagnosticStatus.WARN if warns else DiagnosticStatus.OK
    return DiagnosticStatus(name=name, level=level, message=to_line(forbids or warns))


class WatchTopic:
    """Publishes the reports of a machine's watches on /<machine>/rc/watches: at changes, and twice a second."""

    def __init__(self, app: App, watches: Sequence[Watch]) -> None:
        self._app, self._watches = app, watches
        self._publisher = app.ros.publisher(DiagnosticArray, f"/{app.machine}/rc/watches", depth=1, latched=True)
        self._told, self._at = list[DiagnosticStatus](), float("-inf")
        app.ros.poll_in_thread(LOOK, self._tell, "watches")

    def _tell(self) -> None:
        found, now = [one.report() for one in self._watches], monotonic()
        if found == self._told and now - self._at < PERIOD:
            return
        self._told, self._at = found, now
        message = DiagnosticArray(status=found)
        message.header.stamp = self._app.ros.now()
        self._publisher.publish(message)
