"""What people are told of places."""

from tms_places.claims import Book, Claim, Request
from tms_places.keeper import LEASE, SILENT, Keeper, Report
from tms_places.reasons import (
    HolderSilent,
    HolderUnheard,
    InsideStill,
    KeeperStarts,
    NotGivenBack,
    PlaceUncertain,
    RevokedBy,
    TwoInPlace,
    WaitingCircle,
)
from tms_places.telling import alarms, kept, queue

ROAD = frozenset({"road"})
NONE: frozenset[str] = frozenset()
LEAVING = Claim("a", NONE, 0.0)


def keeper(claim: Claim | None = LEAVING, *queue: Request) -> Keeper:
    return Keeper(("a", "b"), Book(("road",), {} if claim is None else {"road": claim}, queue), 0.0)


def heard(made: Keeper, inside: frozenset[str] = NONE, sure: bool = True, using: frozenset[str] = ROAD) -> Keeper:
    made.report(Report("a", 1, ROAD, inside, sure, using), 0.0, 0.0)
    return made


def test_why_a_place_is_not_freed() -> None:
    assert kept(keeper(), "road", 0.0) == HolderUnheard("a")
    assert kept(heard(keeper(), ROAD), "road", 0.0) == InsideStill("a")
    assert kept(heard(keeper(), sure=False), "road", 0.0) == PlaceUncertain("a")
    assert kept(heard(keeper()), "road", 0.0) == NotGivenBack("a")
    assert kept(heard(keeper()), "road", SILENT + 1.0) == HolderSilent("a", SILENT + 1.0)
    taken = keeper(Claim("a", NONE, 0.0, revoked="T. Yamada"))
    assert kept(heard(taken, ROAD), "road", 0.0) == RevokedBy("T. Yamada", "a", InsideStill("a"))


def test_a_place_that_is_wanted_or_free_needs_no_words() -> None:
    assert kept(keeper(Claim("a", frozenset({"r"}), 0.0)), "road", 0.0) is None
    assert kept(keeper(None), "road", 0.0) is None


def test_a_keeper_that_starts_says_why_nobody_gets_a_free_place() -> None:
    made = keeper(None, Request("b", "r", ("road",), 0.0))
    assert kept(made, "road", 0.0) == KeeperStarts() and queue(made, "road") == list(made.book.queue)
    assert kept(made, "road", LEASE) is None


def test_alarms() -> None:
    book = Book(
        ("p", "q"),
        {"p": Claim("a", frozenset({"r"}), 0.0), "q": Claim("b", frozenset({"r"}), 0.0)},
        (Request("a", "r", ("q",), 0.0), Request("b", "r", ("p",), 0.0)),
        {"c": ("q",), "b": ("q",)},
    )
    assert alarms(Keeper((), book, 0.0)) == [WaitingCircle(("a", "b", "a")), TwoInPlace("c", "q", "b")]
