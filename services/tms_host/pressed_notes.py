"""The stop button, on the disk: the note that a machine is armed is renamed at once.

The gateway does the same when it latches. It may not live to do that, and this process may not live to tell the next
gateway of the press. Without that note the next one is latched.
"""

import threading
from collections.abc import Sequence
from pathlib import Path

from tms_config.clock import unix_ns
from tms_runtime import durable
from tms_runtime.app import App
from tms_runtime.state_folder import armed_note


class PressedNotes:
    """Of the machines whose gateways run on this PC. The disk may stall: it has a thread of its own."""

    def __init__(self, app: App, machines: Sequence[str]) -> None:
        self._app, self._notes = app, [armed_note(app.site.state, machine) for machine in machines]
        self._pressed, self._at = threading.Event(), 0
        app.ros.loop.begin(self._work, "notes of presses")

    def pressed(self) -> None:
        """The button is pressed; does not wait."""
        self._at = unix_ns()
        self._pressed.set()

    def _work(self) -> None:
        while True:
            self._pressed.wait()
            self._pressed.clear()
            for note in self._notes:
                try:
                    press(note, self._at)
                except OSError as error:
                    self._app.log.error("press_not_noted", note=note.name, reason=str(error))


def press(note: Path, at: int) -> None:
    """Note a press of the stop button at a time [ns since 1970]; not where the machine was armed after that.

    Raises:
        OSError: the disk fails.
    """
    try:
        if note.stat().st_mtime_ns >= at:
            return
        note.replace(note.with_suffix(".pressed"))
    except FileNotFoundError:
        return  # it is latched
    durable.sync_folder(note.parent)
