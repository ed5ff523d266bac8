"""The start of a gateway: the last one may have left the machine moving, so it is stopped and held or latched."""

from tms_config.clock import monotonic
from tms_rc.active import StopKind
from tms_rc.guard import Guard
from tms_rc.latch import ANY_LEAF, UNKNOWN_RUN
from tms_rc.latch_file import Left
from tms_rc.reasons import GatewayRestarted, GatewayRestartedHeld, GatewayRestartedUnproven, NoRunTold, TakenByAnother
from tms_rc.standstill import UNKNOWN
from tms_rc.stopper import Stop
from tms_reason.reason import Reason
from tms_ros.reasons import ProcessLost
from tms_runtime.app import App
from tms_runtime.fence import Owner

REACHED = 5.0  # s for the machine's servers to be there
LEFT_MOVING = 2.0  # s that a machine that was left armed and idle is watched for a motion
RUN_KNOWN_LIMIT = 3.0  # s in which the run of a stopped machine must report itself, else the machine is latched
RECOVERY_CHECK_PERIOD = 0.02  # s


class Recovery:
    """Its `run` has a thread of its own; `claimed`, and what `run` posts, run on the executor thread."""

    def __init__(self, app: App, guard: Guard, left: Left) -> None:
        self._app, self._guard, self._left = app, guard, left
        self._open = True  # whether the last gateway may have left a motion of a run that has not reported itself yet
        self._stop: Stop | None = None
        self._begun = monotonic()
        guard.run_reported = self.claimed
        guard.recovering = bool(left.holder)
        guard.by_hand = left.taken
        if left.latched is not None:
            guard.vigil.begin()

    @property
    def _cause(self) -> Reason:
        process, left = self._app.process.full, self._left
        if left.unproven:
            return ProcessLost(GatewayRestartedUnproven(process))
        return ProcessLost(GatewayRestartedHeld(process, left.holder) if left.holder else GatewayRestarted(process))

    def run(self) -> None:
        """Cancel all goals of the machine; stop it if a run held it, or if it moves."""
        guard, app = self._guard, self._app
        deadline = monotonic() + REACHED
        self._command()
        while (
            not guard.controls.reachable() and monotonic() < deadline and not app.stopping.wait(RECOVERY_CHECK_PERIOD)
        ):
            pass
        self._command()
        if self._left.holder or self._left.unproven:
            app.ros.on_executor(lambda: self._take_over(self._left.run or UNKNOWN_RUN))
        deadline = monotonic() + (RUN_KNOWN_LIMIT if self._left.holder else LEFT_MOVING)
        while self._open and guard.active is None and monotonic() < deadline:
            if app.stopping.wait(RECOVERY_CHECK_PERIOD):
                return
            if self._stop is None and guard.watch.moved_at > self._begun:
                deadline = monotonic() + RUN_KNOWN_LIMIT
                app.ros.on_executor(lambda: self._take_over(UNKNOWN_RUN))
        app.ros.on_executor(self._close)
        if self._stop is not None:
            self._stop.wait(app.machine)
        guard.recovering = False

    def _command(self) -> None:
        controls = self._guard.controls
        controls.zero()
        if self._left.latched is not None:
            controls.emergency(True)
        controls.cancel_everything()

    def claimed(self, run: int) -> None:
        """Hold the machine for a run that its scheduler reports, if the machine may have been left moving."""
        if not self._open or self._guard.active is not None:
            return
        self._open = False
        if self._left.run and run != self._left.run:
            self._guard.stop_now(TakenByAnother(self._cause), StopKind.LATCH)
            return
        self._guard.latch.keep(self._cause, Owner(run, ANY_LEAF))
        if self._stop is None or self._stop.run != run:
            self._begin(run)

    def _take_over(self, run: int) -> None:
        if self._open and self._guard.active is None:
            self._guard.recovering = True
            self._guard.latch.keep(self._cause, Owner(run, ANY_LEAF))
            self._begin(run)

    def _begin(self, run: int) -> None:
        number = 0 if run == UNKNOWN_RUN else run
        self._stop = self._guard.stop_now(self._cause, StopKind.PLAIN, run=number, expected=UNKNOWN)

    def _close(self) -> None:
        """End the wait for a run; latch if a motion was stopped and no run has reported itself."""
        known = self._guard.latch.cause or self._guard.active is not None
        if self._open and self._stop is not None and not known:
            self._guard.stop_now(NoRunTold(self._cause), StopKind.LATCH, expected=UNKNOWN)
        self._open = False
