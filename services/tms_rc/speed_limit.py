"""How fast the tracks of a machine may go, told to what drives them; the least of all limits counts."""

import math
import threading

from std_msgs.msg import Float64

from tms_machine.border import speed_limit
from tms_runtime.app import App


class SpeedLimit:
    """The limits of one machine. Safe to call from several threads."""

    def __init__(self, app: App) -> None:
        border = app.site.border(app.machine)
        self.able = app.site.file.backend == "sim" or border.controller == "ours"  # what drives takes a limit
        self._publisher = app.ros.publisher(Float64, speed_limit(app.machine), depth=1, latched=True)
        self._limits: dict[str, float] = {}  # m/s, by who sets them
        self._told = 0.0  # m/s
        self._lock = threading.Lock()

    def set(self, who: str, limit: float) -> None:
        """Set a limit [m/s]; infinite: none."""
        with self._lock:
            self._limits[who] = limit
            least = min(self._limits.values(), default=math.inf)
            if least != self._told:
                self._told = least
                self._publisher.publish(Float64(data=least))
