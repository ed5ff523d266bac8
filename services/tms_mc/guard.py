"""What a motion needs besides a goal: a gateway behind the machine, no emergency stop, and a machine that stands."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from std_msgs.msg import Bool

from tms_config.clock import monotonic
from tms_machine.permit import Permit
from tms_mc.gateway_watch import GatewayWatch
from tms_mc.reasons import EmergencyStopped, GatewayAbsent, StillMoves, Stopped, StopPressed
from tms_reason.reason import Reason
from tms_ros.server import AnyGoal
from tms_runtime.app import App

SETTLES = 20.0  # s that it may take: a simulator that has just begun brings its joints to their targets
POLL = 0.05  # s


class Guard:
    """Says whether the machine may be moved, and stands behind goals by the process's own permit."""

    def __init__(self, app: App, gateway: GatewayWatch) -> None:
        self._app, self._gateway = app, gateway
        self._permit = Permit(app.ros, app.pulse, app.machine, "mc")
        self._pressed = False
        self._watched: list[tuple[Callable[[], Reason | None], Callable[[], bool], Callable[[Reason], None]]] = []
        border = app.site.border(app.machine)
        if border.emg_stop:
            app.ros.subscribe(Bool, f"/{app.machine}/{border.emg_stop}", self._on_stop, depth=10)

    def watch(
        self, unready: Callable[[], Reason | None], stands: Callable[[], bool], stop: Callable[[Reason], None]
    ) -> None:
        """Add joints or tracks: what they lack, whether they stand, and how to stop them."""
        self._watched.append((unready, stands, stop))

    @property
    def closing(self) -> bool:
        """Whether this process ends."""
        return self._app.ros.closing

    def unready(self) -> Reason | None:
        """What the machine lacks, or None."""
        return next((why for unready, _, _ in self._watched if (why := unready()) is not None), None)

    def _missing(self) -> Reason | None:
        """What a motion that begins now would lack, or None."""
        if not self._gateway.alive:
            return GatewayAbsent()
        if (why := StopPressed() if self._pressed else self.unready()) is not None:
            return why
        return None if all(stands() for _, stands, _ in self._watched) else StillMoves()

    def wait(self, goal: AnyGoal) -> Reason | None:
        """Wait until the machine may be moved, and stands; returns why a goal cannot begin."""
        ends = monotonic() + SETTLES
        while (why := self._missing()) is not None and monotonic() < ends:
            if goal.cancelled.wait(POLL):
                return Stopped()
        return why

    @contextmanager
    def working_for(self, goal: AnyGoal) -> Iterator[None]:
        """Stand behind a goal: the gateway notices within half a second if this process is lost."""
        self._permit.hold(goal.uuid)
        try:
            yield
        finally:
            self._permit.drop()

    def _on_stop(self, message: Bool) -> None:
        self._pressed = message.data
        if message.data:
            for _, _, stop in self._watched:
                stop(EmergencyStopped())
