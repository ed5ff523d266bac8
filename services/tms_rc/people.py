"""Services and topics by which people, and the scheduler for them, stop a machine, re-arm it and drive it by hand."""

import secrets
import threading
from collections.abc import Callable
from itertools import count
from typing import Any

from builtin_interfaces.msg import Time
from std_msgs.msg import Bool
from tms_msg_rc.srv import Rearm, StopMachine, TakeMachine

from tms_config.models import Border
from tms_decision import DISK_LIMIT, STOP_PROVEN
from tms_decision.gateway.effects import Rearmed, Stopped, Taken
from tms_decision.gateway.events import (
    Event,
    Manual,
    Pressed,
    RearmAsked,
    Signal,
    StandsIn,
    StoodIn,
    StopAsked,
    TakeAsked,
)
from tms_decision.reasons import CausePersists
from tms_machine.border import standby, stood_in
from tms_rc.shell import Shell
from tms_rc.stop_receipt import message_of
from tms_reason import wire
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_runtime.app import App

SIGNALS = 100  # messages of all stop buttons that may wait: no `false` of one may push out the `true` of another
PRESSES = 10  # presses of the machine's own stop that may wait
ANSWER_LIMIT = STOP_PROVEN + DISK_LIMIT + 5.0  # s; every answer comes before, or the gateway does not work any more
OLD = 3  # s; an older message of the host agent (its topic is latched) is about another press
TOKEN = 4  # bytes

Answer = Stopped | Rearmed | Taken


class People:
    """The calls that wait for an answer of the decisions."""

    def __init__(self, app: App, shell: Shell, border: Border) -> None:
        self._app, self._shell = app, shell
        self._calls = count(1)
        self.unarmed: list[Callable[[], Reason | None]] = []  # why no person may arm the machine now
        self._answers: dict[int, tuple[threading.Event, list[Answer]]] = {}
        shell.does(Stopped, self._answered)
        shell.does(Rearmed, self._answered)
        shell.does(Taken, self._answered)
        ros, machine = app.ros, app.machine
        ros.subscribe(Bool, standby(machine), lambda on: shell.happened(StandsIn(on.data)), latched=True)
        ros.subscribe(Bool, "/emergency_signal", lambda on: shell.happened(Signal(on.data)), depth=SIGNALS)
        if border.emg_stop:
            ros.subscribe(Time, stood_in(machine), self._stood_in, latched=True)
            ros.subscribe(Bool, f"/{machine}/{border.emg_stop}", self._pressed, depth=PRESSES)
        if border.manual:
            topic = f"/{machine}/{border.manual}"
            ros.subscribe(Bool, topic, lambda on: shell.happened(Manual(on.data)), depth=SIGNALS)
        ros.offer_slow(StopMachine, f"/{machine}/rc/stop", self._stop)
        ros.offer_slow(StopMachine, "/tms/stop", self._stop)  # all gateways receive it, the first one answers
        ros.offer_slow(Rearm, f"/{machine}/rearm", self._rearm)
        ros.offer_slow(TakeMachine, f"/{machine}/take", self._take)

    def _stood_in(self, reported: Time) -> None:
        if abs(self._app.ros.now().sec - reported.sec) <= OLD:  # both stamps are of the same PC's clock
            self._shell.happened(StoodIn())

    def _pressed(self, message: Bool) -> None:
        if message.data:
            self._shell.happened(Pressed())

    def stop(self, cause: Reason) -> None:
        """Stop and latch the machine, without waiting for that."""
        self._shell.happened(StopAsked(next(self._calls), cause, orderly=False))

    def _answered(self, answer: Answer) -> None:
        done, answers = self._answers.get(answer.request, (None, []))
        answers.append(answer)
        if done is not None:
            done.set()

    def _ask(self, request: int, event: Event) -> Any:
        """Let a call happen, and wait for its answer."""
        done, answers = self._answers[request] = threading.Event(), []
        self._shell.happened(event)
        try:
            if not done.wait(ANSWER_LIMIT):
                raise RuntimeError("the gateway does not decide any more")
        finally:
            del self._answers[request]
        return answers[0]

    def _stop(self, request: StopMachine.Request, response: StopMachine.Response) -> StopMachine.Response:
        """Stop the machine, also a motion of a foreign client; answers with the receipt."""
        number = next(self._calls)
        answer = self._ask(number, StopAsked(number, wire.of(request.cause), request.orderly))
        response.receipt = message_of(answer.receipt, self._app.machine)
        return response

    def _rearm(self, request: Rearm.Request, response: Rearm.Response) -> Rearm.Response:
        if (wrong := next(filter(None, (one() for one in self.unarmed)), None)) is not None:
            response.error_code, response.error_msg = _wrong(CausePersists(wrong))
            return response
        number = next(self._calls)
        answer = self._ask(number, RearmAsked(number, request.token, secrets.token_hex(TOKEN)))
        response.cause, response.token, response.armed = to_line(answer.cause), answer.token, answer.armed
        response.error_code, response.error_msg = _wrong(answer.wrong)
        return response

    def _take(self, request: TakeMachine.Request, response: TakeMachine.Response) -> TakeMachine.Response:
        number = next(self._calls)
        answer = self._ask(number, TakeAsked(number, request.who, request.back))
        if isinstance(answer, Stopped):
            response.receipt = message_of(answer.receipt, self._app.machine)
        else:
            response.error_code, response.error_msg = _wrong(answer.wrong)
        return response


def _wrong(wrong: Reason | None) -> tuple[str, str]:
    """Code and line of why a call was refused; empty if it was not."""
    return ("", "") if wrong is None else (wrong.code, to_line(wrong))
