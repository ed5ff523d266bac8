"""Why a machine waits for a shared place, by what the keeper tells, and holding places around a goal."""

from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from tms_msg_areas.msg import Place, PlaceRequest, Places
from tms_msg_areas.srv import AskPlaces

from tms_kit import place_holding
from tms_kit.acting import SubtaskCancelled
from tms_kit.place_holding import holding
from tms_kit.site_places import SitePlaces
from tms_places.reasons import WaitsForKeeper, WaitsForLease, WaitsForPlace, WaitsItsTurn
from tms_reason.errors import RosError
from tms_reason.reason import Reason
from tms_ros.reasons import NoServer


class Ros:
    """Brings what the test tells."""

    def __init__(self) -> None:
        self.tell: Any = None
        self.asked: list[Any] = []

    def subscribe(self, _kind: Any, _topic: str, heard: Any, **_: Any) -> None:
        self.tell = heard

    def call_unanswered(self, _kind: Any, _name: str, request: Any) -> None:
        self.asked.append(request)


def told(state: int, holder: str = "", *queue: str, revision: int = 0) -> Places:
    waits = [PlaceRequest(machine=one) for one in queue]
    since = Time(sec=1_700_000_000)
    return Places(revision=revision, places=[Place(name="road", state=state, holder=holder, queue=waits, since=since)])


@pytest.fixture
def ros() -> Ros:
    return Ros()


def test_who_may_go_and_why_others_wait(ros: Ros) -> None:
    site: Any = SitePlaces(ros)  # type: ignore[arg-type]
    assert site.names is None and site.waits("a", "road") == WaitsForKeeper("a", "road")
    ros.tell(told(Place.HELD, "a", "b", "c"))
    assert site.names == ("road",) and site.waits("a", "road") is None
    why = site.waits("b", "road")
    assert isinstance(why, WaitsForPlace) and (why.machine, why.place, why.holder) == ("b", "road", "a")
    assert site.waits("d", "road") == WaitsForKeeper("d", "road")
    ros.tell(told(Place.GRANTED, "a"))
    assert site.waits("a", "road") == WaitsForLease("a", "road")
    ros.tell(told(Place.FREE, "", "b", "c"))
    assert site.waits("c", "road") == WaitsItsTurn("c", "road", "b")
    ros.tell(told(Place.LEAVING, "a", "b", "a"))
    assert site.waits("a", "road") == WaitsItsTurn("a", "road", "b")


def test_a_revoked_place_is_not_held(ros: Ros) -> None:
    site: Any = SitePlaces(ros)  # type: ignore[arg-type]
    ros.tell(told(Place.REVOKED, "a"))
    assert site.waits("a", "road") is not None


class Keeper:
    """Answers `asks` times that it is away, then takes the request; the machine has the place at the third look."""

    def __init__(self, ros: Ros, monkeypatch: pytest.MonkeyPatch, away: int = 0) -> None:
        self.ros, self.away, self.now, self.looks = ros, away, 0.0, 0
        monkeypatch.setattr(place_holding, "ask", self._ask)
        monkeypatch.setattr(place_holding, "monotonic", lambda: self.now)
        monkeypatch.setattr(place_holding, "sleep", self._sleep)

    def _ask(self, _ros: Any, _kind: Any, name: str, request: Any, _limit: float) -> Any:
        self.away -= 1
        if self.away >= 0:
            raise RosError(NoServer("tms:db", name, 3.0))
        self.ros.asked.append(request)
        self.ros.tell(told(Place.HELD, "b", "a", revision=7))
        return AskPlaces.Response(revision=7)

    def _sleep(self, seconds: float) -> None:
        self.now += seconds
        self.looks += 1
        if self.looks == 3 and self.away < 0:
            self.ros.tell(told(Place.HELD, "a", revision=8))


def test_what_was_told_before_the_keeper_took_a_wish_is_no_answer(ros: Ros) -> None:
    site: Any = SitePlaces(ros)  # type: ignore[arg-type]
    ros.tell(told(Place.HELD, "a", revision=4))  # for the goal before, which has freed it since
    site.answered(6)
    assert site.waits("a", "road") == WaitsForKeeper("a", "road")
    ros.tell(told(Place.GRANTED, "a", revision=6))
    assert site.waits("a", "road") == WaitsForLease("a", "road")
    ros.tell(told(Place.HELD, "a", revision=7))
    assert site.waits("a", "road") is None


def test_a_goal_waits_until_the_machine_has_its_places_and_frees_them_after(
    ros: Ros, monkeypatch: pytest.MonkeyPatch
) -> None:
    site: Any = SitePlaces(ros)  # type: ignore[arg-type]
    Keeper(ros, monkeypatch)
    said: list[Reason] = []
    with holding(ros, site, "a", ("road",), said.append):  # type: ignore[arg-type]
        assert {type(why) for why in said} == {WaitsForPlace}
    want, free = ros.asked
    assert want == AskPlaces.Request(machine="a", places=["road"], hold=True)
    assert free == AskPlaces.Request(machine="a", hold=False)


def test_a_keeper_that_is_away_is_asked_again(ros: Ros, monkeypatch: pytest.MonkeyPatch) -> None:
    site: Any = SitePlaces(ros)  # type: ignore[arg-type]
    Keeper(ros, monkeypatch, away=2).looks = -1000
    said: list[Reason] = []

    def waits(why: Reason) -> None:
        said.append(why)
        if isinstance(why, WaitsForPlace):
            raise SubtaskCancelled

    with pytest.raises(SubtaskCancelled), holding(ros, site, "a", ("road",), waits):  # type: ignore[arg-type]
        pytest.fail("it does not hold the place")
    assert said[0] == WaitsForKeeper("a", "road")
    assert [one.hold for one in ros.asked] == [True, False], "a cancel frees what was asked for"


def test_a_goal_that_the_gateway_refuses_for_places_is_sent_again_with_them(
    ros: Ros, monkeypatch: pytest.MonkeyPatch
) -> None:
    from tms_kit import navigating
    from tms_places.reasons import PlacesNeeded
    from tms_reason.errors import SubtaskFailed

    sent: list[str] = []

    def guarded(_self: Any, field: str, *_: Any) -> str:
        sent.append(field)
        if len(sent) == 1:
            raise SubtaskFailed(PlacesNeeded("a", ("road",)))
        return "there"

    Keeper(ros, monkeypatch)
    monkeypatch.setattr(navigating.Navigating, "guarded", guarded)
    machine = navigating.Navigating.__new__(navigating.Navigating)
    site: Any = SitePlaces(ros)  # type: ignore[arg-type]
    machine._ros, machine.name, machine._deadline = ros, "a", float("inf")  # type: ignore[assignment]
    machine._yard = lambda: SimpleNamespace(shared=site)  # type: ignore[assignment, return-value]
    machine.check = lambda: None  # type: ignore[method-assign]
    assert machine._drive(lambda _: None, "follow_path", None, None, lambda _: None) == "there"  # type: ignore[arg-type]
    assert sent == ["follow_path"] * 2 and [one.hold for one in ros.asked] == [True, False]
