"""A machine that loses a place on its way in: the next one gets it when the first can come there no more."""

import pytest

from tms_places.claims import Book
from tms_places.keeper import Keeper
from tms_places.leases import OwnLeases

ROAD = frozenset({"road"})
NONE: frozenset[str] = frozenset()


class Site:
    """A keeper, and the gateways of two machines: `a` has the road, `b` waits for it."""

    def __init__(self) -> None:
        self.now, self.keeper = 0.0, Keeper(("a", "b"), Book(), 0.0)
        self.own = {name: OwnLeases(name) for name in ("a", "b")}
        for name in ("a", "b"):
            self.report(name)
            self.keeper.hold(name, "run", ROAD, self.now)
        self.report("a")
        self.report("a")
        assert self.own["a"].held(self.now) == ROAD and self.holder == "a"

    def report(self, name: str, inside: frozenset[str] = NONE) -> None:
        """A report, and its answer."""
        self.now += 1.0
        own = self.own[name]
        told = own.report(0, ROAD, inside, True, self.now)
        self.keeper.report(told, self.now, self.now)
        self.keeper.grant(self.now, self.now)
        own.answered(told.number, self.keeper.leases(name), inside)

    @property
    def holder(self) -> str:
        return self.keeper.book.claims["road"].machine


def test_a_revoked_place_is_not_free_while_its_holder_still_rolls_in() -> None:
    site = Site()
    site.keeper.revoke("road", "T. Yamada")
    site.report("a")
    assert site.own["a"].open == NONE, "it is closed: the law of areas stops the machine"
    site.report("a")
    assert site.holder == "a"
    for drives in (True, False):
        site.own["a"].give_back(ROAD, sure=True, drives=drives)  # outside, but it cannot stop there any more
        site.report("a")
        assert site.holder == "a"
    site.own["a"].give_back(ROAD, sure=True, drives=False)
    site.report("a", inside=ROAD)  # it stands, and its front is inside
    assert site.holder == "a"
    site.own["a"].give_back(NONE, sure=True, drives=False)
    site.report("a")
    assert site.holder == "b"


@pytest.mark.parametrize("drives", [True, False])
def test_a_revoked_place_is_free_at_once_if_its_holder_is_far_from_it(drives: bool) -> None:
    site = Site()
    site.keeper.revoke("road", "T. Yamada")
    site.report("a")
    site.own["a"].give_back(NONE, sure=True, drives=drives)
    site.report("a")
    assert site.holder == "b"


def test_a_run_that_ends_on_the_way_in_frees_the_place_when_the_machine_cannot_come_there_any_more() -> None:
    site = Site()
    site.keeper.free("a", "run", ())
    site.report("a")
    site.own["a"].give_back(ROAD, sure=True, drives=False)  # its goal is over, but it has not stopped yet
    site.report("a")
    assert site.holder == "a"
    site.own["a"].give_back(NONE, sure=True, drives=False)
    site.report("a")
    assert site.holder == "b"
