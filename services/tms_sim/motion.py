"""One goal of a stand-in and its verdict."""

import threading
from dataclasses import dataclass, field

SUCCEEDED, CANCELED, ABORTED = "SUCCEEDED", "CANCELED", "ABORTED"


@dataclass(frozen=True)
class MotionVerdict:
    """How a motion ended."""

    outcome: str  # SUCCEEDED, CANCELED or ABORTED
    code: int = 0  # code in the action's own result
    text: str = ""


@dataclass(kw_only=True)
class Motion:
    """`verdict` is set before `over`."""

    verdict: MotionVerdict | None = None
    over: threading.Event = field(default_factory=threading.Event)

    def end(self, verdict: MotionVerdict) -> None:
        """Set the verdict; the first one counts."""
        if not self.over.is_set():
            self.verdict = verdict
            self.over.set()
