"""Who else presses the machine's own stop: the host agent in place of this gateway, or somebody that nobody here knows.

What the host agent has pressed while this gateway was frozen or away is released once the machine was seen to stand;
what somebody else has pressed latches, since only a person's re-arm may release it.
"""

from builtin_interfaces.msg import Time
from std_msgs.msg import Bool

from tms_config.clock import monotonic
from tms_machine.border import stood_in
from tms_rc.active import Kind
from tms_rc.guard import Guard
from tms_rc.reasons import PressedByOthers
from tms_runtime.app import App

DEPTH = 10  # presses that may wait
DOUBT = 0.3  # s for the host agent's word to come, if it was its press
YOUNG = 10.0  # s in which a new gateway finds the host agent's two publishers one by one, on a busy PC
YOUNG_DOUBT = 1.5  # s
OLD = 3.0  # s; an older word of the host agent, which it keeps for whoever comes later, is about another press


class Presses:
    """Of one machine that has such a stop. On the executor thread."""

    def __init__(self, app: App, guard: Guard, topic: str) -> None:
        self._app, self._guard = app, guard
        self._begun = monotonic()
        self._doubted = 0  # presses that were not judged yet
        self._reported_at = float("-inf")  # s, monotonic: when the host agent last said that it presses
        app.ros.subscribe(Time, stood_in(app.machine), self._on_stood_in, latched=True)
        app.ros.subscribe(Bool, topic, self._on_press, depth=DEPTH)

    def _on_stood_in(self, reported: Time) -> None:
        if abs(self._app.ros.now().sec - reported.sec) <= OLD:  # of the same PC's clock
            self._reported_at, self._guard.stood_in = monotonic(), True

    def _on_press(self, message: Bool) -> None:
        if message.data and not self._guard.latch.cause:  # latched, this gateway presses it itself
            now = monotonic()
            doubt = YOUNG_DOUBT if now - self._begun < YOUNG else DOUBT
            self._doubted += 1
            self._guard.press_known.clear()
            self._app.ros.after(doubt, lambda: self._judge(now - doubt))

    def _judge(self, since: float) -> None:
        self._doubted -= 1
        if self._reported_at < since and not self._guard.latch.cause:
            self._guard.stop_now(PressedByOthers(), Kind.LATCH)
        if not self._doubted:
            self._guard.press_known.set()
