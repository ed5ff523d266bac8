"""Who else presses the machine's own stop: the host agent in place of this gateway, or somebody that nobody here knows.

What the host agent has pressed while this gateway was frozen or away is released once the machine was seen to stand;
what somebody else has pressed latches, since only a person's re-arm may release it.
"""

from typing import Any

from std_msgs.msg import Bool

from tms_core.app import App
from tms_core.border import stood_in
from tms_rc.guard import Guard, Kind

DEPTH = 10  # presses that may wait
DOUBT = 0.3  # s for the host agent's word to come, if it was its press


class Presses:
    """Of one machine that has such a stop. On the executor thread."""

    def __init__(self, app: App, guard: Guard, topic: str) -> None:
        self._app, self._guard = app, guard
        app.ros.subscribe(Bool, stood_in(app.machine), self._on_stood_in, depth=DEPTH)
        app.ros.subscribe(Bool, topic, self._on_press, depth=DEPTH)

    def _on_stood_in(self, _message: Any) -> None:
        self._guard.stood_in = True

    def _on_press(self, message: Any) -> None:
        if message.data and not self._guard.latch.cause:  # latched, this gateway presses it itself
            self._app.ros.after(DOUBT, self._judge)

    def _judge(self) -> None:
        if not self._guard.stood_in and not self._guard.latch.cause:
            self._guard.stop_now("emg_stop was pressed by somebody else", Kind.LATCH)
