"""Keeps on disk what the latch is: the last word counts, what cannot be kept is reported."""

import threading

from tms_rc.latch import Latch
from tms_rc.latch_file import LatchFile
from tms_rc.reasons import DriverNotKept, StateNotKept
from tms_rc.stopper import UNKEPT
from tms_reason.reason import Reason
from tms_runtime.app import App


class Notes:
    """Between a machine's latch and its memory."""

    def __init__(self, app: App, memory: LatchFile, latch: Latch) -> None:
        self._app, self._memory, self._latch = app, memory, latch
        self._writing = threading.Lock()
        self._kept: tuple[Reason | None, str, int] | None = None  # what the disk says
        self._holder, self._run = "", 0  # who may move the machine now

    def keep(self) -> Reason | None:
        """Have what is so now on the disk; why it is not there."""
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
        """`keep`, from the executor thread."""
        threading.Thread(target=self.keep, name="note", daemon=True).start()

    def hold(self, holder: str, run: int) -> Reason | None:
        """Who may move the machine from now on, empty for nobody, has to be on the disk; why it is not there."""
        self._holder, self._run = holder, run
        return self.keep()

    def release(self) -> None:
        """Nobody's goal moves the machine any more."""
        self._holder, self._run = "", 0
        self.soon()

    def take(self, who: str) -> Reason | None:
        """Who drives by hand; why it is not on the disk."""
        try:
            self._memory.take(who)
        except OSError as error:
            UNKEPT.inc()
            return DriverNotKept(str(error.strerror))
        return None
