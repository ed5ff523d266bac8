"""The mode lamp of a stand-in: what it shows is on /<machine>/sim/lamp."""

from std_msgs.msg import String

from tms_config.clock import monotonic
from tms_runtime.app import App

SILENT = 2.0  # s, four periods of a gateway's state; a lamp that hears nothing shows a fault
PERIOD = 0.25  # s between looks


class LampStandIn:
    """The lamp of one machine."""

    def __init__(self, app: App, machine: str, topic: str) -> None:
        self.shown = ""
        self._heard = float("-inf")
        self._publisher = app.ros.publisher(String, f"/{machine}/sim/lamp", depth=1, latched=True)
        app.ros.subscribe(String, f"/{machine}/{topic}", self.take, latched=True)
        app.ros.every(PERIOD, self.look)
        self._tell("fault")

    def take(self, message: String) -> None:
        """Show what the gateway says."""
        self._heard = monotonic()
        self._tell(message.data)

    def look(self) -> None:
        """Show a fault where the gateway says nothing."""
        if monotonic() - self._heard > SILENT:
            self._tell("fault")

    def _tell(self, shown: str) -> None:
        if shown != self.shown:
            self.shown = shown
            self._publisher.publish(String(data=shown))
