"""Decides whether the machine may move, and stops it: permits, latch, software stop, watch over its stand-still.

Stops begin on the executor thread, where goals are sent, too: a goal has either left before the stop, which then
cancels it, or it is not sent any more.
"""

import threading
from collections.abc import Callable

from std_msgs.msg import Bool
from tms_msg_rc.msg import StopReceipt
from tms_msg_rc.srv import StopMachine

from tms_config.clock import monotonic, sleep
from tms_machine.border import STOP_PROVEN, Controls
from tms_machine.permit import NOBODY, RemotePermit
from tms_machine.reasons import DrivenByHand, NoPermit, SoftwareStop, SoftwareStopSaying
from tms_rc.active import Active, StopKind
from tms_rc.chain import SCHEDULER, gap, members
from tms_rc.latch import Latch
from tms_rc.notes import Notes
from tms_rc.permits import Permits
from tms_rc.reasons import (
    LeftStandStill,
    NotReady,
    NotSeenToStand,
    ProcessesLost,
    Recovering,
    SchedulerLost,
    StillMoved,
    StopUnderWay,
)
from tms_rc.standstill import NOTHING, Expected, StandStill
from tms_rc.stopper import Stop, Stopper
from tms_rc.vigil import Vigil
from tms_reason import wire
from tms_reason.reason import Reason
from tms_ros.loop import POLL
from tms_ros.reasons import ProcessLost
from tms_runtime.app import App
from tms_runtime.fence import Owner

PERMIT_LIMIT = 3.0  # s that a goal may arrive before the permits behind it: a busy PC discovers new processes late
PRESSED = 1.0  # s that a software stop counts as pressed after its last message
FRESH = 1.0  # s; with older messages the machine is not ready
FOREIGN = "a foreign client"


class Guard:
    """Guards one machine."""

    def __init__(self, app: App, watch: StandStill, controls: Controls, latch: Latch, notes: Notes) -> None:
        self._app, self.watch, self.controls = app, watch, controls
        self.latch, self.notes = latch, notes
        self.stopper = Stopper(app, controls, watch, self._note)
        self.vigil = Vigil()
        self._changed = threading.Condition()  # notified when permits change
        self._taking = threading.Lock()
        self.run: int | None = None  # the run that holds the machine
        self.run_reported: Callable[[int], None] = lambda run: None  # called with each run that takes the machine
        self.pressed = 0.0  # monotonic time of the last software stop message
        self.by_hand = ""  # who drives it by hand
        self.stood_in = False  # the host agent has pressed `emg_stop` in place of this gateway
        self.press_known = threading.Event()  # cleared while it is not known who has pressed `emg_stop`
        self.press_known.set()
        self.recovering = False  # a motion that the last gateway may have left is being stopped
        self.active: Active | None = None
        self.reported: Callable[[], None] = lambda: None  # called when the latch has changed, publishes it at once
        self.permits = Permits(app, self._permit_changed)

    def silent(self) -> Reason | None:
        """Which source of the machine is silent."""
        return self.watch.silent(monotonic(), FRESH)

    # who may move

    def take(self, active: Active) -> Reason | None:
        """Let a goal move the machine from now on; returns why it must not."""
        wrong = self._wait_for_permit(active.owner)
        if wrong is not None:
            return wrong
        self.press_known.wait(STOP_PROVEN)
        self.stopper.wait_idle(STOP_PROVEN)
        while self.controls.settling():
            sleep(POLL)
        with self._taking:
            if self.active is not None:
                return StillMoved(self._app.machine)
            wrong = self._kept() or self.latch.refusal(active.owner) or self._noted(active.owner)
            if wrong is None:
                active.chain = members(active.owner, self.permits.held())
                self.active = active
                self.vigil.end()
        return wrong

    def _kept(self) -> Reason | None:
        if self.recovering or self.stopper.busy:
            return NotReady(Recovering() if self.recovering else StopUnderWay())
        return self.driver()

    def driver(self) -> Reason | None:
        """Who drives the machine by hand."""
        return DrivenByHand(wire.known(self.by_hand), self._app.machine) if self.by_hand else None

    def _noted(self, owner: Owner | None) -> Reason | None:
        """Note on the disk whose goal it is, before it leaves: else a power cut would leave the machine armed."""
        if owner is None:
            return self.notes.hold(FOREIGN, 0)
        return self.notes.hold(self.permits.holder() or f"run number {owner.run}", owner.run)

    def last_look(self, active: Active) -> None:
        """Stop a goal before it leaves if a stop or a loss came since it was admitted. On the executor thread."""
        if active.stop is not None:
            return
        refusal, missing = self.latch.refusal(active.owner), gap(active.owner, self.permits.held())
        if refusal is not None:
            self.stop_now(refusal, StopKind.PLAIN)
        elif missing is not None:
            lost = active.owner is not None and not missing.late
            self.stop_now(
                ProcessLost(missing.reason) if lost else missing.reason, StopKind.HOLD if lost else StopKind.PLAIN
            )

    def release(self) -> None:
        """Note that the goal has ended."""
        active, self.active = self.active, None
        if active is not None and active.owner is None and active.stop is None:
            self.notes.release()

    def _wait_for_permit(self, owner: Owner | None) -> Reason | None:
        deadline = monotonic() + PERMIT_LIMIT
        with self._changed:
            while True:
                if self.latch.cause:
                    return self.latch.refusal(owner)
                found, left = gap(owner, self.permits.held()), deadline - monotonic()
                if found is None:
                    return None
                if found.late or left <= 0:
                    return NoPermit(found.reason)
                self._changed.wait(min(left, 0.1))

    def _permit_changed(self, permit: RemotePermit) -> None:
        if permit.process == SCHEDULER:
            self._scheduler_changed(permit)
        self.check_chain()
        with self._changed:
            self._changed.notify_all()

    def _scheduler_changed(self, permit: RemotePermit) -> None:
        run = self.permits.held().get(SCHEDULER)
        if run is None and self.run is not None and permit.goal != NOBODY:
            lost, self.run = self.run, None
            self.latch.run_lost()
            self.stop_now(SchedulerLost(), StopKind.LATCH, run=lost)
            return
        before, self.run = self.run, None if run is None else run.run
        self.latch.run_is(self.run)
        if self.run is not None:
            self.run_reported(self.run)
        elif before is not None:
            self.notes.release()

    def check_chain(self) -> None:
        """Stop the machine when a process behind the present goal is gone."""
        active = self.active
        if active is None or active.stop is not None or active.owner is None:
            return
        held = self.permits.held()
        gone = [name for name, what in active.chain.items() if held.get(name) != what]
        if gone:
            names = tuple(f"{'tms' if name == SCHEDULER else self._app.machine}:{name}" for name in gone)
            self.stop_now(ProcessLost(ProcessesLost(names)), StopKind.HOLD)

    # stop

    def stop_now(
        self, cause: Reason, kind: StopKind, run: int = 0, expected: Expected = NOTHING, broken: Reason | None = None
    ) -> Stop:
        """Stop the machine, whichever client moves it. On the executor thread only; returns at once.

        `expected`, `broken`: see `Stopper.begin`; with a goal under way, `expected` is worked out from that goal.
        """
        active, now, stamp = self.active, monotonic(), self._app.ros.now()
        if kind is StopKind.LATCH:
            self.latch.close(cause)
        elif kind is StopKind.HOLD and active is not None and active.owner is not None:
            self.latch.keep(cause, active.owner)
        ended = active.ended if active is not None else lambda: True
        run = run or (active.owner.run if active is not None and active.owner is not None else self.run or 0)
        latched = kind is StopKind.LATCH
        self.stopper.command(latched)  # before all steps that take time
        if active is not None and active.call is not None:
            active.peer.cancel(active.call)  # also a goal that the machine has not answered yet
        if active is not None and active.stop is None:
            expected = active.expected(now, self.watch.dead_times)
        stop = self.stopper.begin(
            cause, now, stamp, latched=latched, run=run, ended=ended, expected=expected, broken=broken
        )
        if latched:
            self.notes.soon()
        if active is not None:
            active.stop = active.stop or stop
            active.wake()
        self.vigil.begin()
        self.reported()
        return stop

    def check(self) -> None:
        """Check at every beat of the pulse that a stopped machine still stands."""
        now = monotonic()
        self.watch.settle(now)
        if self.active is not None:
            self.watch.commanded(now)
        elif self.vigil.left(now, self.watch.moved_at) and not self.by_hand and not self.stopper.busy:
            self._app.ros.on_executor(self._left_stand_still)

    def _left_stand_still(self) -> None:
        if self.active is None and not self.stopper.busy:
            left = LeftStandStill()
            self.stop_now(left, StopKind.LATCH, broken=left)

    def stop(self, cause: Reason, kind: StopKind) -> Stop:
        """`stop_now` from any other thread; waits for the commands to have left, not for the machine."""
        begun: list[Stop] = []
        there = threading.Event()

        def step() -> None:
            begun.append(self.stop_now(cause, kind))
            there.set()

        self._app.ros.on_executor(step)
        if not there.wait(STOP_PROVEN):
            raise RuntimeError("the gateway's executor does not run any more")
        return begun[0]

    def signal(self, message: Bool) -> None:
        """Receive /emergency_signal: true stops and latches, however often it is repeated; false does not re-arm."""
        now = monotonic()
        if not message.data:
            self.pressed = 0.0
            return
        fresh = now - self.pressed > PRESSED
        self.pressed = now
        if fresh or not self.latch.cause:
            self.stop_now(SoftwareStop(), StopKind.LATCH)

    def stop_service(self, request: StopMachine.Request, response: StopMachine.Response) -> StopMachine.Response:
        """Stop the machine, also a motion of a foreign client; answers with the receipt."""
        cause = wire.of(request.cause) or SoftwareStop()
        if not request.orderly and cause.find(SoftwareStop) is None:
            cause = SoftwareStopSaying(cause)
        stop = self.stop(cause, StopKind.PLAIN if request.orderly else StopKind.LATCH)
        response.receipt = stop.wait(self._app.machine)
        return response

    def _note(self, receipt: StopReceipt) -> None:
        """Keep what a stop has shown, before the receipt is published."""
        if not receipt.confirmed:
            cause, detail = wire.known(receipt.cause), wire.known(receipt.detail)
            self.latch.close(NotSeenToStand(cause, detail, self._app.machine))
            self.controls.emergency(True)
            self.reported()
        elif self.stood_in and not self.latch.cause:
            self.stood_in = False
            self.controls.emergency(False)
        if receipt.confirmed and self.run is None:  # it stands, and no run's goal moves it
            self.notes.hold("", 0)
        else:
            self.notes.keep()
