"""Presses of the stop button that a gateway may have died of: it has shown no latch since. Pure logic."""

from collections.abc import Iterable

from tms_decision.duty import NOTED


class MissedPresses:
    """Of all machines; times are monotonic [s]. Changed by one thread, read by any."""

    def __init__(self, machines: Iterable[str]) -> None:
        self._machines = frozenset(machines)
        self._missed: frozenset[str] = frozenset()
        self._shown: frozenset[str] = frozenset()  # machines whose present gateway shows a latch
        self._at = float("-inf")

    def __contains__(self, machine: str) -> bool:
        """Whether the machine is to be latched once more, as nobody knows that its gateway has heard the button."""
        return machine in self._missed

    def pressed(self, now: float) -> None:
        """The button is pressed. A machine that shows a latch has it; once somebody re-arms it, the press is over."""
        self._missed |= self._machines - self._shown
        self._at = now

    def shows(self, machine: str, latched: bool) -> None:
        """Its gateway tells whether the machine is latched."""
        if latched:
            self._missed -= {machine}
            self._shown |= {machine}
        else:
            self._shown -= {machine}

    def left(self, machine: str) -> None:
        """Its gateway has ended in order: its latch is on the disk."""
        self._shown -= {machine}

    def lost(self, machine: str, now: float) -> None:
        """Its gateway is lost: the latch that it has shown a moment ago may not be on the disk."""
        self._shown -= {machine}
        if now - self._at < NOTED:
            self._missed |= {machine}
