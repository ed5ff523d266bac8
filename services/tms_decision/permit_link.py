"""The permit of another process, as it is heard: which goal that process stands behind, and whether it lives."""

from dataclasses import dataclass

LEASE = 0.5  # s without an assertion until a process counts as lost
GRACE = 0.1  # s more when the reader's own PC did not run for a moment
NOBODY = bytes(16)  # the goal of a process that stands behind none


@dataclass
class PermitLink:
    """One permit, by its messages and by the reports of DDS on who asserts it."""

    process: str
    goal: bytes = NOBODY
    holder: str = ""
    stale_writers: int = 0  # predecessors that discovery has not dropped yet, or the process itself while it is frozen
    left: bool = False  # ended in order; not while a stale writer is there: its end may hide a loss in the same report
    received: float = float("-inf")
    asserts: bool = False
    asserted: int = 0  # writers that are asserted now
    doubted: float | None = None  # since when it may be lost: its assertions may have come, but not been handled yet

    def alive(self, now: float) -> bool:
        """Whether the process works for `goal` now; its message may come before the report that it is asserted."""
        return self.goal != NOBODY and (self.asserts or now - self.received < LEASE)

    def heard(self, goal: bytes, holder: str, now: float) -> None:
        """Take a message of the process."""
        self.received, self.goal, self.holder = now, goal, holder

    def reported(self, alive: int, not_alive: int, late: bool, now: float) -> None:
        """Take a report of DDS: how many writers are asserted, and are not; `late`: this PC did not run just now."""
        if alive > 0 or self.asserted > 0:
            self.left = alive == not_alive == 0
        self.asserted, self.stale_writers = alive, not_alive
        if alive > 0:
            self.asserts, self.doubted = True, None
        elif late and self.asserts:
            self.doubted = now
        else:
            self._lose()

    def judge(self, now: float) -> bool:
        """Whether a doubted process counts as lost from now on; one whose message nobody asserts is doubted."""
        if self.doubted is None and not self.asserts and LEASE <= now - self.received < float("inf"):
            self.doubted = now
        if self.doubted is None or now - self.doubted < GRACE:
            return False
        self._lose()
        return True

    def _lose(self) -> None:
        self.asserts, self.doubted, self.received = False, None, float("-inf")
