"""Who gets a shared place, and when it is free again."""

from typing import Any

import pytest

from tms_places.claims import Book, of_document, to_document
from tms_places.keeper import LEASE, Keeper, Leases, Report
from tms_places.reasons import NoPlace, PlaceFree
from tms_reason.errors import TmsError

ROADS = frozenset({"road", "yard", "gate"})
EMPTY: frozenset[str] = frozenset()


class Site:
    """A keeper, and gateways that report as they are told."""

    def __init__(self, *machines: str) -> None:
        self.machines, self.now, self.number = machines, 0.0, 0
        self.keeper = Keeper(machines, Book(), 0.0)
        for machine in machines:
            self.report(machine)

    def report(self, machine: str, inside: str = "", using: str = "", sure: bool = True) -> Leases:
        self.number, self.now = self.number + 1, self.now + 0.1
        told = Report(machine, self.number, ROADS, _set(inside), sure, _set(using))
        self.keeper.report(told, self.now, self.now)
        self.keeper.grant(self.now, self.now)
        return self.keeper.leases(machine)

    def hold(self, machine: str, *places: str, run: str = "r") -> None:
        self.keeper.hold(machine, f"{run}-{machine}", places, self.now)
        self.keeper.grant(self.now, self.now)

    def free(self, machine: str, *places: str, run: str = "r") -> None:
        self.keeper.free(machine, f"{run}-{machine}", places)
        self.keeper.grant(self.now, self.now)

    def restart(self, **given: Any) -> None:
        self.keeper = Keeper(self.machines, of_document(to_document(self.keeper.book)), self.now)

    def holder(self, place: str) -> str:
        claim = self.keeper.book.claims.get(place)
        return "" if claim is None else claim.machine


def _set(names: str) -> frozenset[str]:
    return frozenset(names.split())


def test_requests_are_granted_in_the_order_of_arrival() -> None:
    site = Site("a", "b", "c")
    for machine in ("b", "a", "c"):
        site.hold(machine, "road")
    assert site.holder("road") == "b" and site.report("b") == Leases(held=_set("road"))
    site.free("b")
    site.report("b")
    assert site.holder("road") == "a"
    site.free("a")
    site.report("a")
    assert site.holder("road") == "c" and not site.keeper.book.queue


def test_a_place_is_not_freed_while_its_holder_is_inside_or_its_pose_is_old_or_it_relies_on_the_lease() -> None:
    site = Site("a", "b")
    site.hold("a", "road")
    site.hold("b", "road")
    site.report("a", using="road")
    site.free("a", "road")
    site.report("a", inside="road", using="road")
    assert site.holder("road") == "a" and site.keeper.leases("a") == Leases(leaving=_set("road"))
    site.report("a", using="road")  # outside, but it has not given it back
    site.report("a", sure=False)  # outside when it was seen last
    assert site.holder("road") == "a"
    site.report("a")
    assert site.holder("road") == "b"


def test_a_silent_holder_keeps_its_place() -> None:
    site = Site("a", "b")
    site.hold("a", "road")
    site.report("a", using="road")
    site.free("a")
    site.hold("b", "road")
    site.now += 100 * LEASE
    site.report("b")
    assert site.holder("road") == "a"


def test_several_places_are_granted_together_or_not_at_all() -> None:
    site = Site("a", "b", "c")
    site.hold("a", "yard")
    site.hold("b", "road", "yard")
    assert site.holder("road") == ""
    site.hold("c", "road")  # came later: whoever waits reserves what it waits for
    assert site.holder("road") == ""
    site.free("a")
    site.report("a")
    assert site.holder("road") == site.holder("yard") == "b"


def test_who_waits_for_a_machine_does_not_keep_from_it_what_that_one_needs() -> None:
    site = Site("a", "b", "c")
    site.hold("a", "yard")
    site.hold("b", "road", "yard")
    site.hold("c", "road")
    site.hold("a", "road")  # the road is free; b, which came first for it, waits for the yard of a
    assert site.holder("road") == "a"
    site.free("a")
    site.report("a")
    assert site.holder("road") == site.holder("yard") == "b"


def test_asking_twice_changes_nothing_and_a_holder_need_not_queue() -> None:
    site = Site("a", "b")
    site.hold("a", "road")
    site.hold("b", "road")
    before = site.keeper.book.queue
    site.hold("b", "road")
    site.hold("a", "road")
    assert site.keeper.book.queue == before and site.holder("road") == "a"


def test_a_place_is_wanted_until_the_last_of_its_runs_and_the_goal_have_freed_it() -> None:
    site = Site("a")
    site.hold("a", "road", run="tree")
    site.hold("a", "road", run="goal")
    site.free("a", run="goal")
    assert site.report("a").held == _set("road")
    site.free("a", run="tree")
    site.report("a")
    assert site.holder("road") == ""


def test_who_is_in_a_free_place_holds_it_and_the_next_one_inside_after_it() -> None:
    site = Site("a", "b", "c")
    site.report("a", inside="road")
    site.report("b", inside="road")
    site.hold("c", "road")
    assert site.holder("road") == "a" and site.keeper.leases("a") == Leases(leaving=_set("road"))
    site.report("a")
    assert site.holder("road") == "b"
    site.report("b")
    assert site.holder("road") == "c"


def test_who_gives_a_place_back_and_wants_it_again_waits_for_those_who_came_first() -> None:
    site = Site("a", "b")
    site.hold("a", "road")
    site.report("a", using="road")
    site.free("a")
    site.hold("a", "road")
    assert site.keeper.leases("a").held == _set("road"), "nobody else wants it"
    site.hold("b", "road")
    site.report("a", inside="road", using="road")
    site.free("a")
    site.hold("a", "road")
    assert site.keeper.leases("a").held == _set("road"), "it is inside"
    site.report("a", using="road")
    site.free("a")
    site.hold("a", "road")
    assert site.keeper.leases("a") == Leases(leaving=_set("road"))
    site.report("a")
    assert site.holder("road") == "b"
    site.free("b")
    site.report("b")
    assert site.holder("road") == "a"


def test_a_run_that_ends_frees_all_its_places_and_requests() -> None:
    site = Site("a", "b")
    site.hold("a", "road")
    site.hold("b", "road")
    site.hold("b", "yard")
    site.keeper.free("", "r-b", ())
    assert not site.keeper.book.queue
    site.report("b")
    assert site.holder("yard") == "" and site.holder("road") == "a"


def test_a_restart_forgets_nothing_and_grants_nothing_until_all_were_heard() -> None:
    site = Site("a", "b", "c")
    site.hold("a", "road")
    site.hold("b", "road")
    site.restart()
    site.hold("c", "yard")
    site.report("c")
    site.report("b")
    assert site.holder("road") == "a" and site.holder("yard") == ""
    site.report("a")
    assert site.holder("yard") == "c"
    site.free("a")
    site.report("a")
    assert site.holder("road") == "b"


def test_after_a_restart_leases_run_out_where_a_gateway_stays_silent() -> None:
    site = Site("a", "b")
    site.restart()
    site.hold("b", "road")
    site.report("b")
    assert site.holder("road") == ""
    site.now += LEASE
    site.report("b")
    assert site.holder("road") == "b"


def test_a_machine_that_a_restart_hears_no_more_is_still_where_it_was_seen_last() -> None:
    site = Site("a", "b")
    site.hold("b", "road")
    site.report("b", using="road")
    site.report("a", inside="road")  # driven in by hand
    site.restart()
    site.now += 10 * LEASE
    site.free("b")
    site.report("b")
    assert site.holder("road") == "a"


def test_a_machine_whose_new_gateway_does_not_know_yet_where_it_is_stays_where_it_was() -> None:
    site = Site("a", "b")
    site.hold("b", "road")
    site.report("b", using="road")
    site.report("a", inside="road")
    site.report("a", sure=False)
    site.free("b")
    site.report("b")
    assert site.holder("road") == "a"


def test_a_lease_that_the_book_does_not_know_counts() -> None:
    site = Site("a", "b")
    site.report("a", using="road")
    site.hold("b", "road")
    assert site.holder("road") == "a"


def test_a_report_that_is_overtaken_by_a_newer_one_changes_nothing() -> None:
    site = Site("a", "b")
    site.hold("a", "road")
    late = Report("a", 0, ROADS, EMPTY, True, EMPTY)
    site.report("a", inside="road", using="road")
    site.free("a")
    site.hold("b", "road")
    site.keeper.report(late, site.now, site.now)
    assert site.holder("road") == "a"


def test_a_revoked_place_is_held_until_its_machine_has_confirmed() -> None:
    site = Site("a", "b")
    site.hold("a", "road")
    site.report("a", using="road")
    site.hold("b", "road")
    assert site.keeper.revoke("road", "T. Yamada") == "a"
    assert site.report("a", inside="road", using="road") == Leases(revoked=_set("road"))
    assert site.report("a", inside="road") == Leases(revoked=_set("road"))
    assert site.holder("road") == "a"
    site.report("a")
    assert site.holder("road") == "b"


def test_who_lost_a_place_by_a_person_queues_again() -> None:
    site = Site("a", "b")
    site.hold("a", "road")
    site.report("a", using="road")
    site.keeper.revoke("road", "T. Yamada")
    site.hold("a", "road")
    assert site.keeper.leases("a").held == EMPTY
    site.report("a")
    assert site.keeper.leases("a").held == _set("road")


def test_a_machine_that_the_site_has_no_more_loses_its_places_to_a_person_at_once() -> None:
    site = Site("a", "b")
    site.report("a", inside="road")
    site.machines = ("b",)
    site.restart()
    site.keeper.revoke("road", "T. Yamada")
    assert site.holder("road") == ""
    site.hold("b", "road")
    site.report("b")
    assert site.holder("road") == "b"


def test_what_is_asked_for_must_be_there() -> None:
    site = Site("a")
    with pytest.raises(TmsError) as caught:
        site.hold("a", "rood")
    assert caught.value.reason == NoPlace("rood", ("gate", "road", "yard"))
    with pytest.raises(TmsError) as caught:
        site.keeper.revoke("road", "T. Yamada")
    assert caught.value.reason == PlaceFree("road")
