"""Who holds which shared place: requests in order of arrival, leases of gateways, and when a place is free again.

A place is freed only when its holder's gateway has told, from a fresh pose, that the machine is outside and that it
lets the lease count no more. So silence frees nothing: neither a dead gateway nor an old pose. A machine that is in a
place holds it, whoever brought it there. A lease runs out at the gateway alone; here it says how long after a start
some gateway may still rely on what an earlier keeper told it.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from tms_places.claims import Book, Claim, Request
from tms_places.reasons import NoPlace, PlaceFree
from tms_places.waits import first, missing
from tms_reason.errors import TmsError

LEASE = 10.0  # s from the moment a gateway sent its report
SILENT = 5.0  # s without a report after which people are told so


@dataclass(frozen=True)
class Report:
    """What a gateway tells."""

    machine: str
    number: int  # larger than that of the one before
    places: frozenset[str]  # release areas of the set that is enabled there
    inside: frozenset[str]  # where its footprint is, or was last
    sure: bool  # its pose is fresh and believed
    using: frozenset[str]  # leases that it lets count
    revision: int = 0  # the newest of the book that it knows


@dataclass(frozen=True)
class Leases:
    """What a gateway is answered; each is good for LEASE."""

    held: frozenset[str] = frozenset()
    leaving: frozenset[str] = frozenset()
    revoked: frozenset[str] = frozenset()
    revision: int = field(default=0, compare=False)  # of the book, as it was then


class Keeper:
    """Its book must be kept before an answer leaves; where that fails, the one before is put back."""

    def __init__(self, machines: Iterable[str], book: Book, now: float) -> None:
        """`machines`: of the site; `now`: monotonic [s]."""
        self.book = book
        self._machines, self._began = frozenset(machines), now
        self.told: dict[str, tuple[float, Report]] = {}  # the last report of a machine, and when it came

    # requests

    def hold(self, machine: str, run: str, places: Iterable[str], unix: float) -> None:
        """A machine wants places for a run.

        Raises:
            TmsError: NoPlace.
        """
        wanted = tuple(sorted(set(places)))
        for place in wanted:
            if place not in self.book.places:
                raise TmsError(NoPlace(place, self.book.places))
        if not any((one.machine, one.run, one.places) == (machine, run, wanted) for one in self.book.queue):
            request = Request(machine, run, wanted, unix)
            self.book = replace(self.book, queue=(*self.book.queue, request))

    def free(self, machine: str, run: str, places: Iterable[str]) -> None:
        """A run wants places no more; without a machine all of it, without places all of the machine."""
        named = frozenset(places)
        for place, claim in self.book.claims.items():
            if machine in ("", claim.machine) and (not named or place in named) and run in claim.wants:
                self.book = self.book.with_claim(place, replace(claim, wants=claim.wants - {run}))
        queue = tuple(one for one in self.book.queue if not _withdrawn(one, machine, run, named))
        self.book = replace(self.book, queue=queue)

    def revoke(self, place: str, who: str) -> str:
        """A person takes a place from its holder; returns that one.

        A machine that the site no longer has cannot confirm it: its places are free at once.

        Raises:
            TmsError: NoPlace, PlaceFree.
        """
        claim = self.book.claims.get(place)
        if claim is None:
            raise TmsError(PlaceFree(place) if place in self.book.places else NoPlace(place, self.book.places))
        gone = claim.machine not in self._machines
        taken = None if gone else replace(claim, wants=frozenset(), revoked=who)
        if gone:
            inside = {one: where for one, where in self.book.inside.items() if one != claim.machine}
            self.book = replace(self.book, inside=inside)
        self.book = self.book.with_claim(place, taken)
        return claim.machine

    # gateways

    def report(self, report: Report, now: float, unix: float) -> None:
        """A gateway tells of its machine; an older report than the last one changes nothing."""
        before = self.told.get(report.machine)
        if before is not None and before[1].number >= report.number:
            return
        self.told[report.machine] = now, report
        known = {place for _, one in self.told.values() for place in one.places} | set(self.book.claims)
        seen_last = frozenset() if report.sure else frozenset(self.book.inside.get(report.machine, ()))
        inside = {**self.book.inside, report.machine: tuple(sorted(report.inside | seen_last))}
        self.book = replace(self.book, places=tuple(sorted(known | set(self._unheard()))), inside=inside)
        for place in report.using | report.inside:
            self._take(place, report.machine, unix)
        for place, claim in self.book.held(report.machine).items():
            if place in report.using and not claim.confirmed and report.revision >= claim.granted:
                self.book = self.book.with_claim(place, replace(claim, confirmed=True))
            elif place not in report.using and place not in report.inside and report.sure and claim.leaving:
                self._freed(place, claim, unix)

    def _unheard(self) -> tuple[str, ...]:
        """Places that are known from the book, as long as a gateway may still have them that was not heard."""
        return self.book.places if not self._machines <= set(self.told) else ()

    def _take(self, place: str, machine: str, unix: float) -> None:
        """A machine is in a free place, or relies on it: it holds it."""
        if place not in self.book.claims:
            self.book = self.book.with_claim(place, Claim(machine, frozenset(), unix, confirmed=True))

    def _freed(self, place: str, claim: Claim, unix: float) -> None:
        others = self.book.others_inside(place, claim.machine)
        after = Claim(others[0], frozenset(), unix, confirmed=True) if others else None
        self.book = self.book.with_claim(place, after)

    def leases(self, machine: str) -> Leases:
        """What a gateway may let count."""
        held = self.book.held(machine)
        revoked = frozenset(place for place, one in held.items() if one.revoked)
        leaving = frozenset(place for place, one in held.items() if one.leaving) - revoked
        return Leases(frozenset(held) - leaving - revoked, leaving, revoked, self.book.revision)

    # grants

    def ready(self, now: float) -> bool:
        """Whether nobody can rely any more on what an earlier keeper granted and this one does not know."""
        return self._machines <= set(self.told) or now - self._began >= LEASE

    def grant(self, now: float, unix: float) -> None:
        """Give places to those who wait, the first one first: who waits reserves what it waits for."""
        if not self.ready(now):
            return
        waiting: list[Request] = []
        for one in self.book.queue:
            closed = any(not self._open(place, one.machine) for place in missing(self.book, one))
            if closed or first(self.book, one, waiting):
                waiting.append(one)
                continue
            for place in one.places:
                self._want(place, one, unix)
        self.book = replace(self.book, queue=tuple(waiting))

    def _want(self, place: str, one: Request, unix: float) -> None:
        """Give a place to a machine, or keep one for it that it was about to leave, which its gateway must know."""
        claim = self.book.claims.get(place) or Claim(one.machine, frozenset(), unix)
        if not claim.wants:
            claim = replace(claim, granted=self.book.revision + 1, confirmed=False)
        self.book = self.book.with_claim(place, replace(claim, wants=claim.wants | {one.run}))

    def _open(self, place: str, machine: str) -> bool:
        return place not in self.book.claims and not self.book.others_inside(place, machine)


def _withdrawn(one: Request, machine: str, run: str, named: frozenset[str]) -> bool:
    return run == one.run and machine in ("", one.machine) and (not named or not named.isdisjoint(one.places))
