"""The keeper of leases: in the database before an answer, kept over a restart, and renewed while the store is away."""

from types import SimpleNamespace
from typing import Any

import mongomock
import pytest
import structlog
from tms_msg_db.srv import LeaseMachines

from stores import Connection
from tms_db import machine_leases
from tms_db.machine_leases import COLLECTION, MachineLeases
from tms_reason import wire
from tms_schedulers.lease_book import LEASE
from tms_schedulers.reasons import LeasesUnread, LeasesUnreadable, MachineLeased


class Site:
    """A keeper in front of a database in memory."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(machine_leases, "monotonic", lambda: self.now)
        self.now = 100.0
        self.db: Any = mongomock.MongoClient()["test"]
        self.connection = Connection()
        self.start()

    def start(self) -> None:
        app: Any = SimpleNamespace(log=structlog.stdlib.get_logger("test"))
        self.keeper = MachineLeases(app, self.db, self.connection)  # type: ignore[arg-type]

    def lease(self, scheduler: str, run_id: str, number: int, *machines: str, over: bool = False) -> Any:
        request = LeaseMachines.Request(scheduler=scheduler, run_id=run_id, number=number, machines=machines, over=over)
        return self.keeper.lease(request, LeaseMachines.Response())


@pytest.fixture
def site(monkeypatch: pytest.MonkeyPatch) -> Site:
    return Site(monkeypatch)


def test_an_answer_tells_how_long_and_the_last_number(site: Site) -> None:
    answer = site.lease("tms:ts", "a", 1_795_830_000_000, "zx200", "ic120")
    assert (answer.error_code, answer.seconds, answer.last) == ("", LEASE, 1_795_830_000_000)
    assert site.lease("", "", 0).last == 1_795_830_000_000
    refused = site.lease("tms:ts_e", "b", 1_795_830_000_001, "ic120")
    assert refused.error_code == "MACHINE_LEASED"
    assert wire.of(refused.error_msg) == MachineLeased("ic120", "a", "tms:ts")


def test_leases_outlive_the_keeper(site: Site) -> None:
    site.lease("tms:ts", "a", 5, "zx200")
    site.now += 3 * LEASE
    site.start()
    assert site.lease("tms:ts_e", "b", 6, "zx200").error_code == "MACHINE_LEASED"
    assert site.lease("tms:ts", "a", 5, "zx200", over=True).error_code == ""
    site.start()
    assert site.lease("tms:ts_e", "b", 6, "zx200").error_code == ""


def test_while_the_store_is_away_leases_are_renewed_and_none_changes_hands(site: Site) -> None:
    site.lease("tms:ts", "a", 5, "zx200")
    site.connection.away = True
    site.now += LEASE / 2
    assert site.lease("tms:ts", "a", 5, "zx200").error_code == ""
    site.now += LEASE / 2
    assert site.lease("tms:ts_e", "b", 6, "zx200").error_code == "MACHINE_LEASED"
    site.now += LEASE
    assert site.lease("tms:ts_e", "b", 6, "zx200").error_code == "STORE_DOWN"
    site.connection.away = False
    assert site.lease("tms:ts", "a", 5, "zx200").error_code == "", "what could not be written did not happen"


def test_who_gives_back_what_it_has_not_renews_nothing(site: Site) -> None:
    site.lease("tms:ts_e", "lost", 5, "zx200")
    for _ in range(3):
        site.now += LEASE / 2
        site.lease("tms:ts", "refused", 6, "zx200", over=True)
    assert site.lease("tms:ts", "next", 7, "zx200").error_code == ""


def test_before_the_book_was_read_nobody_gets_a_machine(site: Site) -> None:
    site.connection.away = True
    answer = site.lease("tms:ts", "a", 5, "zx200")
    assert answer.error_code == "STORE_DOWN" and wire.of(answer.error_msg) == LeasesUnread()


@pytest.mark.parametrize("document", [{}, {"leases": [1]}, {"leases": {"zx200": {"run": "a"}}}])
def test_a_document_that_is_no_book_is_told(site: Site, document: dict[str, Any]) -> None:
    site.db[COLLECTION].insert_one({"_id": "book", **document})
    answer = site.lease("tms:ts", "a", 5, "zx200")
    assert answer.error_code == "BAD_RECORD" and wire.of(answer.error_msg) == LeasesUnreadable()
