"""Who else presses the machine's own stop: the host agent in place of this gateway, or an unknown publisher.

A press of the host agent, made while this gateway was frozen or away, is released once the machine was seen to stand.
A press of any other publisher latches, since only a person's re-arm may release it.
"""

from builtin_interfaces.msg import Time
from std_msgs.msg import Bool

from tms_config.clock import monotonic
from tms_machine.border import stood_in
from tms_rc.active import StopKind
from tms_rc.guard import Guard
from tms_rc.reasons import PressedByOthers
from tms_runtime.app import App

DEPTH = 10  # presses that may wait
DOUBT = 0.3  # s for the host agent's message to come, if it has pressed
YOUNG = 10.0  # s in which a new gateway finds the host agent's two publishers one by one, on a busy PC
YOUNG_DOUBT = 1.5  # s
OLD = 3.0  # s; an older message of the host agent (its topic is latched) is about another press


class Presses:
    """Judges the presses at one machine that has such a stop. On the executor thread."""

    def __init__(self, app: App, guard: Guard, topic: str) -> None:
        self._app, self._guard = app, guard
        self._begun = monotonic()
        self._doubted = 0  # presses that are not judged yet
        self._reported_at = float("-inf")  # s, monotonic: when the host agent last reported a press
        app.ros.subscribe(Time, stood_in(app.machine), self._on_stood_in, latched=True)
        app.ros.subscribe(Bool, topic, self._on_press, depth=DEPTH)

    def _on_stood_in(self, reported: Time) -> None:
        if abs(self._app.ros.now().sec - reported.sec) <= OLD:  # both stamps are of the same PC's clock
            self._reported_at, self._guard.stood_in = monotonic(), True

    def _on_press(self, message: Bool) -> None:
        if message.data and not self._guard.latch.cause:  # of a latched machine, this gateway presses the stop itself
            now = monotonic()
            doubt = YOUNG_DOUBT if now - self._begun < YOUNG else DOUBT
            self._doubted += 1
            self._guard.press_known.clear()
            self._app.ros.after(doubt, lambda: self._judge(now - doubt))

    def _judge(self, since: float) -> None:
        self._doubted -= 1
        if self._reported_at < since and not self._guard.latch.cause:
            self._guard.stop_now(PressedByOthers(), StopKind.LATCH)
        if not self._doubted:
            self._guard.press_known.set()
