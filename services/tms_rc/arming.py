"""What a person does at a stopped machine: re-arm it, take it to drive it by hand, give it back."""

import time

from std_msgs.msg import Bool
from tms_msg_rc.msg import StopReceipt
from tms_msg_rc.srv import Rearm, TakeMachine

from tms_rc.guard import PRESSED, Guard, Kind
from tms_runtime.app import App

PROOF_LIMIT = 3.0  # s that a person waits for a stop that is still being proven
MANUAL = "the machine's own manual mode"


class Arming:
    """Of one machine."""

    def __init__(self, app: App, guard: Guard) -> None:
        self._app, self._guard = app, guard

    def rearm(self, request: Rearm.Request, response: Rearm.Response) -> Rearm.Response:
        """Two steps: without a token the cause and a token, with it the machine is armed. It may wait for the disk."""
        guard = self._guard
        guard.stopper.wait_idle(PROOF_LIMIT)
        now = time.monotonic()
        response.cause = guard.latch.cause or guard.latch.hold
        code, text = self._keeps_from_arming(response.cause)
        if not code and request.token:
            text = guard.latch.confirm(request.token, now) or ""
            code = "BAD_TOKEN" if text else ""
            if not code:
                code, text = self._arm(response.cause)
        elif not code:
            response.token = guard.latch.request(now)
        response.armed = not guard.latch.cause and not guard.latch.hold
        response.error_code, response.error_msg = code, text
        return response

    def _arm(self, cause: str) -> tuple[str, str]:
        """The note first: a machine counts as armed when the disk says so."""
        guard = self._guard
        unkept = guard.notes.hold("", 0)
        if unkept is not None:
            guard.latch.close(cause)
            return "NOT_KEPT", unkept
        guard.watch.accept_clocks()
        guard.controls.emergency(False)
        guard.stood_in = False
        guard.vigil.end(time.monotonic())
        self._app.log.info("armed")
        guard.told()
        return "", ""

    def _keeps_from_arming(self, cause: str) -> tuple[str, str]:
        guard, machine, now = self._guard, self._app.machine, time.monotonic()
        if not cause:
            return "NOT_STOPPED", f"{machine} is armed: there is nothing to do"
        if guard.active is not None:
            return "STILL_ACTIVE", f"{machine} still has an open goal: cancel its run first"
        if guard.by_hand:
            return "TAKEN", f"{guard.by_hand} drives {machine} by hand: `tms give-back {machine}` first"
        if now - guard.pressed < PRESSED:
            return "CAUSE_PERSISTS", "the software stop is still pressed: release it (false on /emergency_signal)"
        silent, trouble = guard.silent(), guard.watch.trouble(now)
        if silent is not None:
            return "CAUSE_PERSISTS", f"nobody sees whether {machine} stands: {silent}; is the machine on?"
        if trouble is not None and not trouble.passes:
            return "CAUSE_PERSISTS", f"what {machine} tells cannot be believed: {trouble.text}"
        if guard.stopper.busy:
            return "CAUSE_PERSISTS", f"a stop of {machine} is still being proven"
        if not guard.watch.standing(now, passing=True):
            return "CAUSE_PERSISTS", f"{machine} does not stand still yet"
        return "", ""

    # by hand

    def take(self, request: TakeMachine.Request, response: TakeMachine.Response) -> TakeMachine.Response:
        """Let a person drive: nothing of ours moves the machine, and nothing is commanded against it. Or the end of it.

        Watching, latch and alarms stay as they are.
        """
        code, text = self._keeps_from_giving() if request.back else self._keeps_from_taking(request.who)
        if not code:
            text = self._guard.notes.take("" if request.back else request.who) or ""
            code = "NOT_KEPT" if text else ""
        if not code and request.back:
            response.receipt = self._give_back(request.who)
        elif not code:
            self._guard.by_hand = request.who
            self._app.log.warning("taken", who=request.who)
            self._guard.told()
        response.error_code, response.error_msg = code, text
        return response

    def _give_back(self, who: str) -> StopReceipt:
        self._guard.by_hand = ""
        stop = self._guard.stop(f"given back by {who}", Kind.PLAIN)
        return stop.wait(self._app.machine)

    def _keeps_from_taking(self, who: str) -> tuple[str, str]:
        guard, machine = self._guard, self._app.machine
        if not who.strip() or not who.isprintable():
            return "NAMELESS", "say who drives: `tms take MACHINE --by NAME`"
        if guard.by_hand:
            return "TAKEN", f"{guard.by_hand} drives {machine} by hand already"
        if guard.active is not None:
            return "STILL_ACTIVE", f"{machine} still has an open goal: cancel its run first"
        if guard.run is not None:
            return "HELD_BY_RUN", f"run {guard.permits.holder()} holds {machine}: cancel it first"
        return "", ""

    def _keeps_from_giving(self) -> tuple[str, str]:
        if not self._guard.by_hand or self._guard.by_hand == MANUAL:
            return "NOT_TAKEN", f"nobody has taken {self._app.machine}: `tms status` shows who drives what"
        return "", ""

    def manual(self, message: Bool) -> None:
        """The machine's own signal that a person drives it by its levers. On the executor thread."""
        guard, on = self._guard, bool(message.data)
        if on and not guard.by_hand:
            guard.stop_now(f"{MANUAL} was switched on", Kind.PLAIN)
            guard.by_hand = MANUAL
        elif not on and guard.by_hand == MANUAL:
            guard.by_hand = ""
            guard.stop_now(f"{MANUAL} was switched off", Kind.PLAIN)
        guard.told()
