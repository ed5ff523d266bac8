"""Whether a machine may move: armed, held for its own run, or latched until a person re-arms it. Pure logic.

A stop latches. Only one kind of stop does not: when a subtask, the planner or the gateway itself is lost during a
run, the machine is *held*: only the run that has lost the process may move it, with a new leaf goal. If that run is
lost too, the hold becomes a latch. An orderly end of the run ends the hold.
"""

import secrets
import threading
from dataclasses import dataclass

from tms_machine.reasons import MachineLatched
from tms_rc.reasons import Held, ThenSchedulerLost, TokenOld, TokenUnknown
from tms_reason.reason import Reason
from tms_runtime.fence import Owner

TOKEN_SECONDS = 60.0  # s that a person has between the two steps
ANY_LEAF = -1  # no leaf has this number: any leaf of the run may leave the hold
UNKNOWN_RUN = -1  # no run has this number: no goal may leave the hold until its run is known


@dataclass(frozen=True)
class Hold:
    """The state after a stop that only its own run may leave."""

    cause: Reason
    run: int
    leaf: int


class Latch:
    """Safe to call from several threads; waits only for its own short lock."""

    def __init__(self, machine: str, cause: Reason | None = None) -> None:
        self._lock = threading.Lock()
        self._machine, self._cause = machine, cause
        self._hold: Hold | None = None
        self._token: tuple[str, float] | None = None

    @property
    def cause(self) -> Reason | None:
        """Why the machine is latched, None if it is not."""
        return self._cause

    @property
    def hold(self) -> Reason | None:
        """Why the machine is held, None if it is not."""
        hold = self._hold
        return hold.cause if hold is not None else None

    def close(self, cause: Reason) -> None:
        """Latch. The first cause stays; tokens that were given out before become invalid."""
        with self._lock:
            self._cause = self._cause or cause
            self._hold = self._token = None

    def keep(self, cause: Reason, owner: Owner) -> None:
        """Hold the machine for the run that just lost one of its processes."""
        with self._lock:
            if not self._cause:
                self._hold = Hold(cause, owner.run, owner.leaf)

    def refusal(self, owner: Owner | None) -> Reason | None:
        """Why a goal may not move the machine; a goal that may leave a hold ends it."""
        with self._lock:
            if self._cause:
                return MachineLatched(self._machine, self._cause)
            hold = self._hold
            if hold is None:
                return None
            if owner is not None and owner.run == hold.run and owner.leaf != hold.leaf:
                self._hold = None
                return None
            return Held(hold.cause)

    def run_is(self, run: int | None) -> None:
        """Set which run holds the machine; an orderly change of the run ends a hold for another run."""
        with self._lock:
            if self._hold is not None and self._hold.run not in (UNKNOWN_RUN, run):
                self._hold = None

    def run_lost(self) -> None:
        """Latch a held machine: the scheduler of its run is lost as well."""
        with self._lock:
            if self._hold is not None:
                self._cause, self._hold = ThenSchedulerLost(self._hold.cause), None

    def request(self, now: float) -> str:
        """First step of re-arming: returns a token for the second."""
        with self._lock:
            token = secrets.token_hex(4)
            self._token = (token, now + TOKEN_SECONDS)
            return token

    def confirm(self, token: str, now: float) -> Reason | None:
        """Second step; returns why it is refused, None when the machine is armed."""
        with self._lock:
            known, self._token = self._token, None
            if known is None or not secrets.compare_digest(known[0].encode(), token.encode()):
                return TokenUnknown()
            if now > known[1]:
                return TokenOld(TOKEN_SECONDS)
            self._cause = self._hold = None
            return None
