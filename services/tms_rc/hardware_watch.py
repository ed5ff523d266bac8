"""Watches what the hardware of a machine tells, in a thread of its own."""

from collections.abc import Callable

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from tms_config.clock import monotonic
from tms_decision.gateway.events import Manual
from tms_decision.gateway.state import Gateway
from tms_decision.reasons import ProcessLost
from tms_hardware.hardware import Condition, Known
from tms_rc.latch_order import LatchOrder
from tms_rc.reasons import HardwareLate
from tms_rc.shell import Shell
from tms_rc.watches import status
from tms_reason.reason import Reason
from tms_runtime.app import App
from tms_sensors.hardware import HardwareHearing

PERIOD = 0.03  # s between looks
LATE = 0.3  # s; an older look is none


class HardwareWatch:
    """The hardware of one machine, as its gateway sees it."""

    def __init__(self, app: App, shell: Shell, gateway: Gateway, stop: Callable[[Reason], None]) -> None:
        """`stop`: has the machine stopped and latched, without waiting."""
        self._hearing = HardwareHearing(app.ros, app.site, app.machine)
        self._shell, self._gateway, self._order = shell, gateway, LatchOrder(gateway, stop)
        self._manual = False  # what the decisions were told
        # Replaced, never changed: read without a lock.
        self.condition, self.state, self._at = Condition(), dict[str, Known](), monotonic()
        app.ros.poll_in_thread(PERIOD, self._look, "hardware")

    # what others ask; none of it waits

    def unready(self, drives: bool = True) -> Reason | None:
        """Why nothing may begin to move, and no person may arm the machine."""
        return self.condition.wrong or self._late()

    def astray(self) -> Reason | None:
        """Why what moves must stop; a loss, if that may pass by itself."""
        condition = self.condition
        if condition.stop is not None:
            return condition.stop
        held = condition.hold or condition.lost
        return self._late() if held is None else ProcessLost(held)

    def report(self) -> DiagnosticStatus:
        """What the hardware says: yes, no or unknown."""
        found = status("hardware", self.condition.wrong)
        found.values = [KeyValue(key=name, value=says) for name, says in self.state.items()]
        return found

    def _late(self) -> Reason | None:
        age = monotonic() - self._at
        return ProcessLost(HardwareLate(age)) if age > LATE else None

    # the watch

    def _look(self) -> None:
        hardware, now = self._hearing.take(), monotonic()
        self.condition, self.state, self._at = hardware.look(now), hardware.state(now), now
        self._order.armed()
        self._order.give(now, self.condition.stop)
        said = self.state.get("manual", "no")
        manual = self._manual if said == "unknown" else said == "yes"
        # A goal under way ends first, so that its run may wait; then no command opposes the person at the levers.
        if manual != self._manual and (not manual or self._gateway.active is None):
            self._manual = manual
            self._shell.happened(Manual(manual))
