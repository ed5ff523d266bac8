"""Watches for people and vehicles among the machines, in a thread of its own: no stop waits for geometry."""

from collections.abc import Callable

from diagnostic_msgs.msg import DiagnosticStatus

from tms_areas.intruders import Danger
from tms_areas.zones import Zones
from tms_config.clock import monotonic
from tms_decision.gateway.state import Gateway
from tms_decision.reasons import ProcessLost
from tms_machine.sensing import load_sensing
from tms_rc.area_file import Enabled
from tms_rc.area_watch import AreaWatch
from tms_rc.latch_order import LatchOrder
from tms_rc.reasons import IntrudersLate
from tms_rc.watches import status
from tms_reason.reason import Reason
from tms_runtime.app import App
from tms_sensors.trackers import Hearing

PERIOD = 0.03  # s between looks; with the beats and the executor a message becomes a command within 0.2 s
LATE = 0.3  # s; an older verdict is none


class IntruderWatch:
    """The trackers of the site, as one gateway sees them."""

    def __init__(self, app: App, gateway: Gateway, areas: AreaWatch, stop: Callable[[Reason], None]) -> None:
        """`stop`: has the machine stopped and latched, without waiting."""
        self._app, self._areas, self._order = app, areas, LatchOrder(gateway, stop)
        self._hearing = Hearing(app.ros, load_sensing(app.site).trackers)
        self._enabled: Enabled | None = None
        self._zones: Zones | None = None
        self.danger, self._at = Danger(), monotonic()  # replaced, never changed: read without a lock
        app.ros.poll_in_thread(PERIOD, self._look, "intruders")

    # what others ask; none of it waits

    def unready(self) -> Reason | None:
        """Why nothing may begin to move."""
        return self.astray() or self.danger.passed

    def unarmed(self) -> Reason | None:
        """Why no person may arm the machine: an area must be seen free."""
        return self.danger.present

    def astray(self) -> Reason | None:
        """Why what moves must stop; a loss, if that may pass by itself."""
        danger, age = self.danger, monotonic() - self._at
        if danger.stop is not None:
            return danger.stop
        if age > LATE:
            return ProcessLost(IntrudersLate(age))
        return None if danger.hold is None else ProcessLost(danger.hold)

    def report(self) -> DiagnosticStatus:
        """Who is in the way, or near."""
        return status("people", self.danger.present or self.danger.passed, self.danger.warn)

    # the watch

    def _look(self) -> None:
        intruders, enabled = self._hearing.take(), self._areas.enabled
        if enabled is not self._enabled:
            self._enabled, self._zones = enabled, None if enabled is None else Zones(enabled.areas)
        if self._order.armed():
            intruders.looked()
        now = monotonic()
        if self._zones is not None:
            self._tell(intruders.look(now, self._zones, self._app.machine, self._areas.here))
        self._at = now
        self._order.give(now, self.danger.stop or self.danger.passed, intruders.openings)

    def _tell(self, danger: Danger) -> None:
        before, self.danger = self.danger, danger
        if danger.warn is not None and before.warn is None:
            self._app.log.warning("intruder", reason=danger.warn)
