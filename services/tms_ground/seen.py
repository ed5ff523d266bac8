"""Heights that somebody has measured: topic /tms/ground/seen. Newer evidence wins, cell by cell."""

import threading

from prometheus_client import Counter
from tms_msg_ground.msg import HeightPatch

from tms_config.clock import unix_time
from tms_ground.reasons import SeenFromFuture, SeenNotHeights
from tms_ground.watching import GroundWatch
from tms_machine.stamps import seconds
from tms_reason.reason import Reason
from tms_runtime.app import App
from tms_soil.patches import heights

SEEN = "/tms/ground/seen"
AHEAD = 1.0  # s that clocks of two PCs may differ
NOISE = 0.05  # m, what scanners of construction sites may be off: less does not change the ground
MESSAGES = Counter("tms_ground_seen_total", "Measured heights by what became of them", ["result"])


class Seen:
    """Takes them into the ground."""

    def __init__(self, app: App, watch: GroundWatch, lock: threading.Lock) -> None:
        """`lock`: while it is held, the ground does not change."""
        self._log, self._watch, self._lock = app.log, watch, lock
        self._told: type[Reason] | None = None  # a kind of refusal is told once
        app.ros.subscribe(HeightPatch, SEEN, self.receive, depth=5)

    def receive(self, message: HeightPatch) -> None:
        """Take heights, where nothing newer is known."""
        stamp = seconds(message.header.stamp)
        if (ahead := stamp - unix_time()) > AHEAD:
            return self._refuse(SeenFromFuture(ahead))
        try:
            seen = heights(message)
        except ValueError as error:
            return self._refuse(SeenNotHeights(str(error)))
        with self._lock:
            self._watch.measured(seen, stamp, NOISE)
            self._watch.touched = True
        self._told = None
        MESSAGES.labels("taken").inc()
        return None

    def _refuse(self, why: Reason) -> None:
        MESSAGES.labels("refused").inc()
        if type(why) is not self._told:
            self._told = type(why)
            self._log.warning("seen_refused", reason=why)
