"""The objects that the runtime gives to every process."""

import threading
from collections.abc import Callable

from tms_config.config import Site
from tms_config.processes import Process
from tms_reason.reason import Reason
from tms_ros.node import Ros
from tms_runtime.hanging import Hanging
from tms_runtime.log import Logger
from tms_runtime.pulse import Pulse
from tms_runtime.reasons import ProcessStarting


class App:
    """Configuration, ROS, log and life cycle of one process."""

    def __init__(self, site: Site, process: Process, ros: Ros, log: Logger) -> None:
        self.site = site
        self.process = process
        self.ros = ros
        self.pulse = Pulse(ros)
        self.hanging = Hanging(ros)
        self.log = log
        self.stopping = threading.Event()
        self.unready: Callable[[], Reason | None] = ProcessStarting  # why the process cannot do its job now, or None
        self._cleanup: list[Callable[[], None]] = []

    @property
    def machine(self) -> str:
        """Machine instance that this process belongs to."""
        assert self.process.machine is not None, f"{self.process.full} belongs to no machine"
        return self.process.machine

    def ready_when(self, unready: Callable[[], Reason | None]) -> None:
        """Set the function that returns why this process cannot work now, or None if it can."""
        self.unready = unready

    def on_stop(self, step: Callable[[], None]) -> None:
        """Run `step` when the process stops, last registered first; it must be quick."""
        self._cleanup.append(step)

    def stop(self) -> None:
        """Run the registered steps; called once by the runtime."""
        self.stopping.set()
        for step in reversed(self._cleanup):
            step()
