"""The gateway's side of shared places: which of them are open to its machine, and what it reports.

A lease counts from the moment its report was sent, so it ends here before anybody else may think so. An answer to an
older report than the last one is none: the keeper may have freed since then what it grants.

A place that is lost is closed at once. But a machine that was on its way in cannot stop at once, so it is told to be
in use until it is out of reach: else the next machine would get it while this one still rolls in.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field

from tms_places.keeper import LEASE, Leases, Report

PERIOD = 3.0  # s between reports
SOON = 0.3  # s, where something is to be told or expected


@dataclass
class OwnLeases:
    """The leases of one machine; all times monotonic [s]."""

    machine: str
    evacuates: frozenset[str] = frozenset()  # places out of which it may still drive when it has lost them
    until: dict[str, float] = field(default_factory=dict)  # when the lease of a place in use ends
    closing: frozenset[str] = frozenset()  # not open, but the machine may come there before it stands
    leaving: frozenset[str] = frozenset()
    revoked: frozenset[str] = frozenset()
    revision: int = 0  # the newest of the keeper's book that was heard
    answer: int = 0  # the one of the last answer
    number: int = 0  # of the last report
    sent: float = 0.0

    def report(self, number: int, places: Iterable[str], inside: frozenset[str], sure: bool, now: float) -> Report:
        """What to tell the keeper now; `number`: of nanoseconds since 1970, so it is larger after a restart, too."""
        self.number, self.sent = max(number, self.number + 1), now
        known = self.answer if self.closing else self.revision  # what is closing is no place that it may drive into yet
        return Report(self.machine, self.number, frozenset(places), inside, sure, self.using, known)

    def answered(self, number: int, told: Leases, inside: frozenset[str], lease: float = LEASE) -> None:
        """The keeper's answer to a report."""
        if number != self.number:
            return
        self.revision = self.answer = told.revision
        keeps = told.held | (told.leaving & (self.until.keys() | inside))
        keeps |= told.revoked & self.evacuates & inside
        self.leaving, self.revoked = told.leaving, told.revoked
        self.closing = self.using - keeps
        self.until = {place: self.sent + lease for place in keeps}

    def heard(self, mine: Iterable[str], leaving: frozenset[str], revision: int) -> None:
        """What the keeper tells all: its places, and those that nobody wants for it; older news is none."""
        if revision >= self.revision:
            self.revision = revision
            self.leaving = (self.leaving | leaving) - (frozenset(mine) - leaving)

    def give_back(self, near: frozenset[str], sure: bool, drives: bool) -> None:
        """Let those count no more that nobody wants, once the machine is outside and no goal drives it.

        `near`: where it is, or may come until it stands. What is closed needs no more than to be out of that.
        """
        if not sure:
            return
        for place in () if drives else (self.leaving | self.revoked) - near:
            self.until.pop(place, None)
        self.closing = near - self.open

    @property
    def open(self) -> frozenset[str]:
        """Places that are not closed to the machine. In those that are `lost`, it must not go on."""
        return frozenset(self.until)

    @property
    def using(self) -> frozenset[str]:
        """Places that nobody else may get yet."""
        return self.open | self.closing

    def lost(self, now: float) -> frozenset[str]:
        """Places whose lease is over, or that were revoked: nothing may drive in or stay on the move inside."""
        return frozenset(place for place, end in self.until.items() if end <= now or place in self.revoked)

    def held(self, now: float) -> frozenset[str]:
        """Places into which it may drive."""
        return frozenset(self.until) - self.lost(now) - self.leaving
