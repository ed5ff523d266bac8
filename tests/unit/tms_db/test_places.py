"""The keeper's process: what it grants is in the database first, and what cannot be written does not happen."""

from types import SimpleNamespace
from typing import Any

import mongomock
import pytest
from tms_msg_areas.msg import Place
from tms_msg_areas.srv import AskPlaces, ReportPlaces, RevokePlace

from stores import Connection
from tms_db.place_book import PlaceBook
from tms_db.places import PlaceServices
from tms_places.claims import Book, Claim
from tms_places.keeper import LEASE
from tms_reason import wire
from tms_reason.errors import DbError


class Site:
    """A keeper in front of a database in memory."""

    def __init__(self) -> None:
        self.db: Any = mongomock.MongoClient()["test"]
        self.connection = Connection()
        self.numbers = self.revision = 0
        self.start()

    def start(self) -> None:
        self.told: list[Any] = []
        self.acts: list[Any] = []
        lists = {"/tms/places": self.told, "/tms/places/acts": self.acts}
        nothing = SimpleNamespace(
            info=lambda *_, **__: None, warning=lambda *_, **__: None, error=lambda *_, **__: None
        )
        publisher = lambda _, topic, **__: SimpleNamespace(publish=lists[topic].append)  # noqa: E731
        app: Any = SimpleNamespace(
            ros=SimpleNamespace(publisher=publisher), log=nothing,
            site=SimpleNamespace(file=SimpleNamespace(machines={"a": None, "b": None})),
        )  # fmt: skip
        self.keeper = PlaceServices(app, self.db, self.connection)  # type: ignore[arg-type]

    def ask(self, machine: str, *places: str, hold: bool = True) -> str:
        request = AskPlaces.Request(machine=machine, run="r", places=places, hold=hold)
        return str(self.keeper.ask(request, AskPlaces.Response()).error_code)

    def report(self, machine: str, in_use: tuple[str, ...] = (), inside: tuple[str, ...] = ()) -> Any:
        self.numbers += 1
        request = ReportPlaces.Request(
            machine=machine,
            number=self.numbers,
            places=["road"],
            inside=inside,
            sure=True,
            in_use=in_use,
            revision=self.revision,
        )
        answer = self.keeper.report(request, ReportPlaces.Response())
        self.revision = answer.revision
        return answer

    def both(self) -> None:
        self.report("a")
        self.report("b")

    @property
    def road(self) -> Any:
        (place,) = self.told[-1].places
        return place


@pytest.fixture
def site() -> Site:
    made = Site()
    made.both()
    return made


def test_a_book_is_read_as_it_was_written(site: Site) -> None:
    book = Book(("road",), {"road": Claim("a", frozenset({"r", ""}), 2.5, True, "me", 7)}, (), {"a": ("road",)}, 9)
    PlaceBook(site.db).write(book)
    assert PlaceBook(site.db).read() == book
    site.db["place"].update_one({}, {"$set": {"claims": [{"place": "road"}]}})
    with pytest.raises(DbError):
        PlaceBook(site.db).read()


def test_a_place_is_granted_told_confirmed_and_freed(site: Site) -> None:
    assert site.ask("a", "road") == ""
    assert (site.road.state, site.road.holder, site.road.run) == (Place.GRANTED, "a", "r")
    assert PlaceBook(site.db).read().claims["road"].machine == "a"
    answer = site.report("a")
    assert (answer.lease, list(answer.held)) == (LEASE, ["road"])
    site.report("a", in_use=("road",))
    assert site.road.state == Place.HELD
    site.ask("b", "road")
    assert [one.machine for one in site.road.queue] == ["b"]
    site.ask("a", "road", hold=False)
    assert list(site.report("a", in_use=("road",), inside=("road",)).leaving) == ["road"]
    assert site.road.state == Place.LEAVING and "INSIDE_STILL" in site.road.reason
    site.report("a")
    assert (site.road.state, site.road.holder) == (Place.GRANTED, "b")


def test_without_the_store_nothing_changes_hands_and_leases_are_renewed(site: Site) -> None:
    site.ask("a", "road")
    site.connection.away = True
    assert site.ask("b", "road") == "STORE_DOWN"
    assert site.ask("a", "road", hold=False) == "STORE_DOWN"
    assert list(site.report("a", in_use=("road",)).held) == ["road"]
    site.start()  # a keeper that has not read its book knows nothing
    assert site.report("a", in_use=("road",)).error_code == "STORE_DOWN"
    site.connection.away = False
    assert list(site.report("a", in_use=("road",)).held) == ["road"]


def test_a_restart_grants_nothing_until_all_gateways_were_heard(site: Site) -> None:
    site.start()
    site.ask("a", "road")
    site.report("a")
    assert site.road.state == Place.FREE and "KEEPER_STARTS" in site.road.reason
    site.report("b")
    assert site.road.holder == "a"


def test_a_person_revokes(site: Site) -> None:
    request = RevokePlace.Request(place="road", who="T. Yamada")
    assert site.keeper.revoke(request, RevokePlace.Response()).error_code == "PLACE_FREE"
    site.ask("a", "road")
    site.report("a", in_use=("road",))
    assert site.keeper.revoke(request, RevokePlace.Response()).holder == "a"
    (act,) = site.acts
    assert (act.kind, act.node, act.text) == ("revoke_place", "road of a", "T. Yamada")
    assert site.road.state == Place.REVOKED and wire.of(site.road.reason).person == "T. Yamada"  # type: ignore[union-attr]
    assert list(site.report("a", in_use=("road",)).revoked) == ["road"]
    site.report("a")
    assert site.road.state == Place.FREE


def test_an_unknown_place_is_refused_and_a_circle_is_told(site: Site) -> None:
    assert site.ask("a", "rood") == "NO_PLACE"
    for machine, place in (("a", "road"), ("b", "yard"), ("a", "yard"), ("b", "road")):
        site.numbers += 1
        told = ReportPlaces.Request(machine="a", number=site.numbers, places=["road", "yard"], sure=True)
        site.keeper.report(told, ReportPlaces.Response())
        assert site.ask(machine, place) == ""
    assert len(site.told[-1].alarms) == 1 and "WAITING_CIRCLE" in site.told[-1].alarms[0]
