"""Which places are open to a machine by what its gateway was answered."""

from tms_places.keeper import LEASE, Leases
from tms_places.leases import OwnLeases

NONE: frozenset[str] = frozenset()
ROAD = frozenset({"road"})


def told(own: OwnLeases, now: float, answer: Leases, inside: frozenset[str] = NONE) -> None:
    report = own.report(int(now * 1e9), ROAD, inside, True, now)
    own.answered(report.number, answer, inside)


def test_a_lease_counts_from_the_moment_its_report_was_sent() -> None:
    own = OwnLeases("a")
    told(own, 100.0, Leases(held=ROAD))
    assert own.open == own.held(100.0) == ROAD
    assert own.lost(100.0 + LEASE - 0.1) == NONE
    assert own.lost(100.0 + LEASE) == ROAD and own.held(100.0 + LEASE) == NONE


def test_an_answer_to_an_older_report_is_none() -> None:
    own = OwnLeases("a")
    first = own.report(1, ROAD, NONE, True, 1.0)
    own.report(2, ROAD, NONE, True, 2.0)
    own.answered(first.number, Leases(held=ROAD), NONE)
    assert own.open == NONE


def test_numbers_grow_though_the_clock_goes_back() -> None:
    own = OwnLeases("a")
    assert [own.report(number, ROAD, NONE, True, 0.0).number for number in (5, 3, 9)] == [5, 6, 9]


def test_a_place_is_given_back_outside_standing_and_sure_of_it() -> None:
    own = OwnLeases("a")
    told(own, 1.0, Leases(held=ROAD))
    own.give_back(NONE, sure=True, drives=False)
    assert own.open == ROAD  # it is still wanted
    told(own, 2.0, Leases(leaving=ROAD), inside=ROAD)
    for near, sure, drives in ((ROAD, True, False), (NONE, False, False), (NONE, True, True)):
        own.give_back(near, sure, drives)
        assert own.open == ROAD
    assert own.held(2.0) == NONE
    own.give_back(NONE, sure=True, drives=False)
    assert own.open == NONE and own.report(3, ROAD, NONE, True, 3.0).using == NONE


def test_who_was_found_inside_may_drive_out_and_who_is_outside_gets_nothing_anew() -> None:
    own = OwnLeases("a")
    told(own, 1.0, Leases(leaving=ROAD), inside=ROAD)
    assert own.open == ROAD
    other = OwnLeases("a")
    told(other, 1.0, Leases(leaving=ROAD))
    assert other.open == NONE


def test_a_revoked_place_is_closed_at_once_but_for_the_way_out_of_one_that_says_so() -> None:
    own, evacuating = OwnLeases("a"), OwnLeases("a", evacuates=ROAD)
    for one in (own, evacuating):
        told(one, 1.0, Leases(held=ROAD))
        told(one, 2.0, Leases(revoked=ROAD), inside=ROAD)
    assert own.open == NONE
    assert evacuating.open == evacuating.lost(2.0) == ROAD
    evacuating.give_back(NONE, sure=True, drives=False)
    assert evacuating.open == NONE


def test_a_place_that_the_keeper_does_not_know_of_is_closed() -> None:
    own = OwnLeases("a")
    told(own, 1.0, Leases(held=ROAD))
    told(own, 2.0, Leases())
    assert own.open == NONE


def test_what_is_lost_is_in_use_until_the_machine_cannot_come_there_any_more() -> None:
    own = OwnLeases("a")
    told(own, 1.0, Leases(held=ROAD))
    for answer in (Leases(revoked=ROAD), Leases()):
        told(own, 2.0, answer)
        assert own.open == NONE and own.using == ROAD, "nobody has looked yet where it is"
        own.give_back(ROAD, sure=True, drives=True)
        own.give_back(NONE, sure=False, drives=False)
        assert own.open == NONE and own.report(3, ROAD, NONE, True, 3.0).using == ROAD
        own.give_back(NONE, sure=True, drives=True)
        assert own.report(4, ROAD, NONE, True, 4.0).using == NONE, "it is closed: it drives past it"
        told(own, 5.0, Leases(held=ROAD))
        assert own.open == ROAD


def test_a_machine_that_a_new_gateway_finds_on_its_way_into_a_place_keeps_it_from_others() -> None:
    own = OwnLeases("a")
    own.give_back(ROAD, sure=True, drives=False)
    assert own.open == NONE and own.report(1, ROAD, NONE, True, 1.0).using == ROAD


def test_what_is_closing_is_not_confirmed_before_it_is_open() -> None:
    own = OwnLeases("a")
    own.give_back(ROAD, sure=True, drives=False)
    own.heard(ROAD, NONE, 7)
    report = own.report(1, ROAD, NONE, True, 1.0)
    assert (report.using, report.revision) == (ROAD, 0)
    own.answered(report.number, Leases(held=ROAD, revision=7), NONE)
    assert own.held(1.0) == ROAD and own.report(2, ROAD, NONE, True, 1.0).revision == 7
