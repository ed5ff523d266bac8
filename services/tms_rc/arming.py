"""What a person does at a stopped machine: re-arm it, take it to drive it by hand, give it back."""

from std_msgs.msg import Bool
from tms_msg_rc.msg import StopReceipt
from tms_msg_rc.srv import Rearm, TakeMachine

from tms_config.clock import monotonic
from tms_machine.reasons import ManualMode
from tms_rc.active import StopKind
from tms_rc.guard import PRESSED, Guard
from tms_rc.reasons import (
    BadToken,
    CausePersists,
    GivenBack,
    HeldByRun,
    ManualOff,
    ManualOn,
    Nameless,
    NotBelieved,
    NotKept,
    NotSeen,
    NotStill,
    NotStopped,
    NotTaken,
    StillActive,
    StillPressed,
    StillProven,
)
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_runtime.app import App

PROOF_LIMIT = 3.0  # s that a person waits for a stop that is still being proven
MANUAL = to_line(ManualMode())  # as the name of who drives


class Arming:
    """Serves re-arm, take and give back of one machine."""

    def __init__(self, app: App, guard: Guard) -> None:
        self._app, self._guard = app, guard

    def rearm(self, request: Rearm.Request, response: Rearm.Response) -> Rearm.Response:
        """Two steps: a call without a token returns cause and token, one with it arms. It may wait for the disk."""
        guard = self._guard
        guard.stopper.wait_idle(PROOF_LIMIT)
        now = monotonic()
        cause = guard.latch.cause or guard.latch.hold
        response.cause = to_line(cause)
        wrong = NotStopped(self._app.machine) if cause is None else self._keeps_from_arming()
        if wrong is None and cause is not None and request.token:
            refused = guard.latch.confirm(request.token, now)
            wrong = self._arm(cause) if refused is None else BadToken(refused)
        elif wrong is None:
            response.token = guard.latch.request(now)
        response.armed = guard.latch.cause is None and guard.latch.hold is None
        _fill(response, wrong)
        return response

    def _arm(self, cause: Reason) -> Reason | None:
        """Write the note first: a machine counts as armed only when the note on the disk says so."""
        guard = self._guard
        unkept = guard.notes.hold("", 0)
        if unkept is not None:
            guard.latch.close(cause)
            return NotKept(unkept)
        guard.watch.accept_clocks()
        guard.controls.emergency(False)
        guard.stood_in = False
        guard.vigil.end(monotonic())
        self._app.log.info("armed")
        guard.reported()
        return None

    def _keeps_from_arming(self) -> Reason | None:
        guard, machine, now = self._guard, self._app.machine, monotonic()
        if guard.active is not None:
            return StillActive(machine)
        if guard.by_hand:
            return guard.driver()
        if now - guard.pressed < PRESSED:
            return CausePersists(StillPressed())
        silent, trouble = guard.silent(), guard.watch.trouble(now)
        if silent is not None:
            return CausePersists(NotSeen(machine, silent))
        if trouble is not None and not trouble.passes:
            return CausePersists(NotBelieved(machine, trouble.reason))
        if guard.stopper.busy:
            return CausePersists(StillProven(machine))
        if not guard.watch.standing(now, passing=True):
            return CausePersists(NotStill(machine))
        return None

    # by hand

    def take(self, request: TakeMachine.Request, response: TakeMachine.Response) -> TakeMachine.Response:
        """Let a person drive the machine, or end that: meanwhile no goal moves it, and no command opposes the person.

        The gateway still watches the machine; latch and alarms stay as they are.
        """
        wrong = self._keeps_from_giving() if request.back else self._keeps_from_taking(request.who)
        if wrong is None and (unkept := self._guard.notes.take("" if request.back else request.who)) is not None:
            wrong = NotKept(unkept)
        if wrong is None and request.back:
            response.receipt = self._give_back(request.who)
        elif wrong is None:
            self._guard.by_hand = request.who
            self._app.log.warning("taken", who=request.who)
            self._guard.reported()
        _fill(response, wrong)
        return response

    def _give_back(self, who: str) -> StopReceipt:
        self._guard.by_hand = ""
        stop = self._guard.stop(GivenBack(who), StopKind.PLAIN)
        return stop.wait(self._app.machine)

    def _keeps_from_taking(self, who: str) -> Reason | None:
        guard, machine = self._guard, self._app.machine
        if not who.strip() or not who.isprintable():
            return Nameless()
        if guard.by_hand:
            return guard.driver()
        if guard.active is not None:
            return StillActive(machine)
        if guard.run is not None:
            return HeldByRun(guard.permits.holder(), machine)
        return None

    def _keeps_from_giving(self) -> Reason | None:
        if not self._guard.by_hand or self._guard.by_hand == MANUAL:
            return NotTaken(self._app.machine)
        return None

    def manual(self, message: Bool) -> None:
        """The machine's own signal that a person drives it by its levers. On the executor thread."""
        guard, on = self._guard, bool(message.data)
        if on and not guard.by_hand:
            guard.stop_now(ManualOn(), StopKind.PLAIN)
            guard.by_hand = MANUAL
        elif not on and guard.by_hand == MANUAL:
            guard.by_hand = ""
            guard.stop_now(ManualOff(), StopKind.PLAIN)
        guard.reported()


def _fill(response: Rearm.Response | TakeMachine.Response, wrong: Reason | None) -> None:
    """Fill in why the call was refused, or that it was not."""
    response.error_code, response.error_msg = ("", "") if wrong is None else (wrong.code, to_line(wrong))
