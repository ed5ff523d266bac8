"""Whether a machine may move: armed, held for its own run, or latched until a person re-arms it.

A stop latches. Only one kind of stop does not: when a subtask, the planner or the gateway itself is lost during a
run, the machine is *held*: only the run that has lost the process may move it, with a new leaf goal. If that run is
lost too, the hold becomes a latch. An orderly end of the run ends the hold.
"""

from dataclasses import dataclass
from hmac import compare_digest

from tms_decision.data import Data
from tms_decision.owner import Owner
from tms_decision.reasons import Held, MachineLatched, ThenSchedulerLost, TokenOld, TokenUnknown
from tms_reason.reason import Reason

TOKEN_SECONDS = 60.0  # s that a person has between the two steps
ANY_LEAF = -1  # no leaf has this number: any leaf of the run may leave the hold
UNKNOWN_RUN = -1  # no run has this number: no goal may leave the hold until its run is known


class Hold(Data):
    """The state after a stop that only its own run may leave."""

    cause: Reason
    run: int
    leaf: int


@dataclass
class Latch:
    """The latch of one machine."""

    machine: str
    cause: Reason | None = None  # why the machine is latched, None if it is not
    held: Hold | None = None
    token: tuple[str, float] | None = None  # and until when it is valid
    closings: int = 0  # how often it was closed: a re-arm that waits for the disk is void when this has grown

    @property
    def hold(self) -> Reason | None:
        """Why the machine is held, None if it is not."""
        return self.held.cause if self.held is not None else None

    def close(self, cause: Reason) -> None:
        """Latch. The first cause stays; tokens that were given out before become invalid."""
        self.cause = self.cause or cause
        self.held = self.token = None
        self.closings += 1

    def keep(self, cause: Reason, owner: Owner) -> None:
        """Hold the machine for the run that just lost one of its processes."""
        if self.cause is None:
            self.held = Hold(cause, owner.run, owner.leaf)

    def refusal(self, owner: Owner | None) -> Reason | None:
        """Why a goal may not move the machine; a goal that may leave a hold ends it."""
        if self.cause is not None:
            return MachineLatched(self.machine, self.cause)
        hold = self.held
        if hold is None:
            return None
        if owner is not None and owner.run == hold.run and owner.leaf != hold.leaf:
            self.held = None
            return None
        return Held(hold.cause)

    def run_is(self, run: int | None) -> None:
        """Set which run holds the machine; an orderly change of the run ends a hold for another run."""
        if self.held is not None and self.held.run not in (UNKNOWN_RUN, run):
            self.held = None

    def run_lost(self) -> None:
        """Latch a held machine: the scheduler of its run is lost as well."""
        if self.held is not None:
            self.close(ThenSchedulerLost(self.held.cause))

    def request(self, token: str, now: float) -> None:
        """First step of re-arming: give out a token for the second."""
        self.token = token, now + TOKEN_SECONDS

    def confirm(self, token: str, now: float) -> Reason | None:
        """Second step; returns why it is refused, None when the machine may be armed. A token is good for one try."""
        known, self.token = self.token, None
        if known is None or not compare_digest(known[0].encode(), token.encode()):
            return TokenUnknown()
        return TokenOld(TOKEN_SECONDS) if now > known[1] else None

    def open(self) -> None:
        """Arm the machine, or end its hold."""
        self.cause = self.held = None
