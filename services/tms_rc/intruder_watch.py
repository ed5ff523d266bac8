"""Watches for people and vehicles among the machines, in a thread of its own: no stop waits for geometry."""

import math
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
NEAR = 0.3  # m/s of tracks while somebody is in a restricted area: our choice, slower than people walk
LATE = 0.3  # s; an older verdict is none


class IntruderWatch:
    """The trackers of the site, as one gateway sees them."""

    def __init__(
        self, app: App, gateway: Gateway, areas: AreaWatch, drives: Callable[[int], bool],
        stop: Callable[[Reason], None],
    ) -> None:  # fmt: skip
        """`drives`: whether the goal with a number moves the tracks; `stop`: stops and latches, without waiting."""
        self._gateway, self._drives = gateway, drives
        self._app, self._areas, self._order = app, areas, LatchOrder(gateway, stop)
        self._hearing = Hearing(app.ros, load_sensing(app.site).trackers)
        self._enabled: Enabled | None = None
        self._zones: Zones | None = None
        self.danger, self._at = Danger(), monotonic()  # replaced, never changed: read without a lock
        app.ros.poll_in_thread(PERIOD, self._look, "intruders")

    # what others ask; none of it waits

    def unready(self, drives: bool) -> Reason | None:
        """Why nothing may begin to move; `drives`: by its tracks."""
        return self._forbids(drives) or self.danger.passed

    def unarmed(self) -> Reason | None:
        """Why no person may arm the machine: an area must be seen free."""
        return self.danger.present

    def astray(self) -> Reason | None:
        """Why what moves must stop; a loss, if that may pass by itself."""
        active = self._gateway.active
        return self._forbids(active is None or self._drives(active.number))

    def _forbids(self, drives: bool) -> Reason | None:
        danger, age = self.danger, monotonic() - self._at
        if danger.stop is not None:
            return danger.stop
        if age > LATE:
            return ProcessLost(IntrudersLate(age))
        near = None if drives and self._areas.speed.able else danger.warn  # else tracks go slowly
        held = danger.hold or near
        return None if held is None else ProcessLost(held)

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
        self._areas.speed.set("people", math.inf if danger.warn is None else NEAR)
        if danger.warn is not None and before.warn is None:
            self._app.log.warning("intruder", reason=danger.warn)
