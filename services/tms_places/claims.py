"""What is kept of shared places in the database: who holds them, and who waits for them."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any


@dataclass(frozen=True)
class Claim:
    """A machine holds a place."""

    machine: str
    wants: frozenset[str]  # runs that want it for the machine; "" is the machine itself, for a goal; none: it leaves
    since: float  # s since 1970
    confirmed: bool = False  # its gateway lets the lease count, and knows of `granted`
    revoked: str = ""  # by whom
    granted: int = 0  # revision of the book from which on some run has wanted it all the time

    @property
    def leaving(self) -> bool:
        """Whether it is given back as soon as that is safe."""
        return bool(self.revoked) or not self.wants


@dataclass(frozen=True)
class Request:
    """A machine waits for places, which it gets together or not at all."""

    machine: str
    run: str
    places: tuple[str, ...]
    since: float  # s since 1970


@dataclass(frozen=True)
class Book:
    """All of it. It is replaced, never changed: what could not be written did not happen."""

    places: tuple[str, ...] = ()
    claims: Mapping[str, Claim] = field(default_factory=dict)  # by place
    queue: tuple[Request, ...] = ()  # in the order of arrival
    inside: Mapping[str, tuple[str, ...]] = field(default_factory=dict)  # places where a machine is, or was seen last
    revision: int = 0  # larger after every claim that changed: of two news, the older one tells nothing

    def held(self, machine: str) -> dict[str, Claim]:
        """The places of a machine."""
        return {place: claim for place, claim in self.claims.items() if claim.machine == machine}

    def with_claim(self, place: str, claim: Claim | None) -> "Book":
        """The same with another claim, or none, on a place."""
        rest = {name: one for name, one in self.claims.items() if name != place}
        claims = rest if claim is None else {**rest, place: claim}
        return replace(self, claims=claims, revision=self.revision + 1)

    def others_inside(self, place: str, machine: str) -> list[str]:
        """Other machines that are in a place, or were seen last there."""
        return [one for one, places in self.inside.items() if place in places and one != machine]


def to_document(book: Book) -> dict[str, Any]:
    """A book as the database keeps it."""
    claims = [
        {
            "place": place,
            "machine": one.machine,
            "wants": sorted(one.wants),
            "since": one.since,
            "granted": one.granted,
            "confirmed": one.confirmed,
            "revoked": one.revoked,
        }
        for place, one in sorted(book.claims.items())
    ]
    queue = [{**vars(one), "places": list(one.places)} for one in book.queue]
    inside = {machine: list(places) for machine, places in sorted(book.inside.items()) if places}
    return {
        "places": list(book.places), "claims": claims, "queue": queue, "inside": inside, "revision": book.revision,
    }  # fmt: skip


def of_document(found: Mapping[str, Any]) -> Book:
    """The book of `to_document`.

    Raises:
        KeyError, TypeError, ValueError: it is none.
    """
    claims = {
        str(one["place"]): Claim(
            str(one["machine"]), frozenset(map(str, one["wants"])), float(one["since"]), bool(one["confirmed"]),
            str(one["revoked"]), int(one["granted"]),
        )
        for one in found["claims"]
    }  # fmt: skip
    queue = tuple(
        Request(str(one["machine"]), str(one["run"]), tuple(map(str, one["places"])), float(one["since"]))
        for one in found["queue"]
    )
    inside = {str(machine): tuple(map(str, places)) for machine, places in found["inside"].items()}
    return Book(tuple(map(str, found["places"])), claims, queue, inside, int(found["revision"]))
