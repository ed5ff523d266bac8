"""Keeps the state of the latch on the disk, the newest one only; reports a state that cannot be kept."""

import threading

from tms_rc.latch import Latch
from tms_rc.latch_file import LatchFile
from tms_rc.reasons import DriverNotKept, StateNotKept
from tms_rc.stopper import UNKEPT
from tms_reason.reason import Reason
from tms_runtime.app import App


class Notes:
    """Writes the latch of a machine into its latch file."""

    def __init__(self, app: App, memory: LatchFile, latch: Latch) -> None:
        self._app, self._memory, self._latch = app, memory, latch
        self._writing = threading.Lock()
        self._kept: tuple[Reason | None, str, int] | None = None  # the state on the disk
        self._holder, self._run = "", 0  # who may move the machine now

    def keep(self) -> Reason | None:
        """Write the present state to the disk; returns why that failed."""
        with self._writing:
            now = (self._latch.cause, self._holder, self._run)
            if now == self._kept:
                return None
            try:
                if now[0] is not None:
                    self._memory.latch(now[0])
                else:
                    self._memory.arm(self._holder, self._run)
            except OSError as error:
                self._kept = None
                UNKEPT.inc()
                self._app.log.error("note_not_kept", reason=str(error))
                return StateNotKept(str(error.strerror))
            self._kept = now
        return None

    def soon(self) -> None:
        """Call `keep` in a thread, for callers on the executor thread."""
        threading.Thread(target=self.keep, name="note", daemon=True).start()

    def hold(self, holder: str, run: int) -> Reason | None:
        """Write who may move the machine from now on (empty: no run) to the disk; returns why that failed."""
        self._holder, self._run = holder, run
        return self.keep()

    def release(self) -> None:
        """Write that no goal moves the machine any more."""
        self._holder, self._run = "", 0
        self.soon()

    def take(self, who: str) -> Reason | None:
        """Write who drives by hand; returns why that failed."""
        try:
            self._memory.take(who)
        except OSError as error:
            UNKEPT.inc()
            return DriverNotKept(str(error.strerror))
        return None
