"""Which of several schedulers' runs has a machine."""

import pytest

from tms_reason.errors import TaskError
from tms_reason.reason import Reason
from tms_schedulers.lease_book import LEASE, Lease, LeaseBook
from tms_schedulers.reasons import MachineLeased, RunOutdated

A, B = Lease("tms:ts", "a", 5), Lease("tms:ts_east", "b", 6)


def take(book: LeaseBook, lease: Lease, *machines: str, now: float = 0.0) -> dict[str, Lease]:
    changed = book.wanted(lease, machines, now)
    book.put(changed, machines, now)
    return changed


def give_back(book: LeaseBook, lease: Lease, *machines: str) -> None:
    book.put(book.given_back(lease, machines), (), 0.0)


def refusal(book: LeaseBook, lease: Lease, *machines: str, now: float = 0.0) -> Reason:
    before = dict(book.leases)
    with pytest.raises(TaskError) as caught:
        book.wanted(lease, machines, now)
    assert book.leases == before
    return caught.value.reason


def test_all_machines_of_a_run_or_none() -> None:
    book = LeaseBook({}, 0.0)
    assert take(book, A, "zx200") == {"zx200": A}
    assert refusal(book, B, "ic120", "zx200") == MachineLeased("zx200", "a", "tms:ts")
    assert take(book, B, "ic120") == {"ic120": B}


def test_a_lease_goes_on_while_it_is_renewed_and_changes_nothing() -> None:
    book = LeaseBook({}, 0.0)
    take(book, A, "zx200")
    for now in (0.9 * LEASE, 1.8 * LEASE):
        assert take(book, A, "zx200", now=now) == {}
    assert refusal(book, B, "zx200", now=2.7 * LEASE) == MachineLeased("zx200", "a", "tms:ts")
    assert take(book, B, "zx200", now=2.8 * LEASE) == {"zx200": B}


def test_who_was_away_for_too_long_does_not_get_it_back() -> None:
    book = LeaseBook({}, 0.0)
    take(book, A, "zx200")
    take(book, B, "zx200", now=LEASE)
    assert refusal(book, A, "zx200", now=LEASE) == MachineLeased("zx200", "b", "tms:ts_east")
    assert refusal(book, A, "zx200", now=3 * LEASE) == RunOutdated("zx200", "b")


def test_a_machine_that_was_given_back_is_free_at_once_for_a_newer_run() -> None:
    book = LeaseBook({}, 0.0)
    take(book, A, "zx200")
    give_back(book, A, "zx200")
    assert refusal(book, A, "zx200") == RunOutdated("zx200", "a")
    assert refusal(book, Lease("tms:ts_east", "c", 4), "zx200") == RunOutdated("zx200", "a")
    assert take(book, B, "zx200") == {"zx200": B}


def test_what_is_another_run_s_by_now_is_not_given_back() -> None:
    book = LeaseBook({}, 0.0)
    take(book, A, "zx200")
    take(book, B, "zx200", now=LEASE)
    assert book.given_back(A, ["zx200", "ic120"]) == {}


def test_a_scheduler_gets_a_machine_of_its_own_run_that_was_lost_with_it() -> None:
    book = LeaseBook({"zx200": A}, 0.0)
    assert take(book, Lease("tms:ts", "a", 7), "zx200")["zx200"].number == 7  # resumed
    assert take(book, Lease("tms:ts", "c", 8), "zx200")["zx200"].run_id == "c"


def test_kept_leases_count_anew() -> None:
    book = LeaseBook({"zx200": A}, 100.0)
    assert refusal(book, B, "zx200", now=100.0 + 0.9 * LEASE) == MachineLeased("zx200", "a", "tms:ts")
    assert take(book, B, "zx200", now=100.0 + LEASE) == {"zx200": B}


def test_the_largest_number() -> None:
    assert LeaseBook({}, 0.0).last == 0
    assert LeaseBook({"zx200": B, "ic120": A}, 0.0).last == 6
