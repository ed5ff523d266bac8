"""The gateway's side of shared places: what it reports, what its leases open, and which goals need places first."""

from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_areas.msg import Place, Places
from tms_msg_areas.srv import ReportPlaces

from areas.history import Outline
from areas.shared import TRACKS
from tms_areas.areas import Area, AreaSet
from tms_areas.fix import Motion, Seen
from tms_areas.guard import Guard
from tms_areas.law import Law
from tms_areas.reasons import EntersArea, LeavesArea, PoseOld
from tms_places.keeper import LEASE
from tms_places.reasons import LeaseOver, OnlyOut, PlacesNeeded
from tms_rc import place_watch
from tms_rc.place_watch import PlaceWatch
from tms_reason.errors import RosError
from tms_ros.reasons import NoServer

BODY = ((-2.5, -1.5), (2.5, -1.5), (2.5, 1.5), (-2.5, 1.5))
YARD = Area("yard", "unmanned", ((-40, -15), (60, -15), (60, 15), (-40, 15)))


def area(name: str, west: float, east: float, on_loss: Any = "stop") -> Area:
    return Area(name, "release", ((west, -15), (east, -15), (east, 15), (west, 15)), on_loss=on_loss)


class Gateway:
    """A watch whose keeper answers what the test says; its thread is the test."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *areas: Area) -> None:
        import numpy as np

        self.now, self.sent, self.answer = 100.0, list[Any](), ReportPlaces.Response(lease=LEASE)
        self.silent = False
        monkeypatch.setattr(place_watch, "monotonic", lambda: self.now)
        monkeypatch.setattr(place_watch, "ask", self._ask)
        self.steps: list[Any] = []
        ros = SimpleNamespace(
            subscribe=lambda *_, **__: None, poll_in_thread=lambda _, step, name: self.steps.append(step)
        )
        log = SimpleNamespace(warning=lambda *_, **__: None)
        app: Any = SimpleNamespace(machine="m", ros=ros, log=log)
        self.watch, self.areas = PlaceWatch(app), AreaSet((YARD, *areas))
        self.outline: Any = Outline(np.array(BODY))
        self.watch.enable(self.areas)

    def _ask(self, _ros: Any, _kind: Any, _name: str, request: Any, _limit: float) -> Any:
        self.sent.append(request)
        if self.silent:
            raise RosError(NoServer("tms:db", "/tms/places/report", 2.0))
        return self.answer

    def guard(self, held: frozenset[str]) -> Guard:
        return Guard(Law(self.areas, "m", TRACKS, held), self.outline)

    def look(self, x: float, drives: bool = False, sure: bool = True, speed: float = 0.0) -> Any:
        seen = Seen(None if sure else PoseOld(1.0), Motion(x, 0.0, 0.0, speed))
        return self.watch.look(self.guard(self.watch.open), {}, seen, drives)

    def report(self, **answer: list[str]) -> Any:
        self.answer = ReportPlaces.Response(lease=LEASE, **answer)
        self.watch._due = 0.0
        self.steps[0]()
        return self.sent[-1]

    def go(self, x: float, to: float, told: bool = True) -> Any:
        seen = Seen(None, Motion(x, 0.0, 0.0))
        return self.watch.judged(self.guard, seen, {}, [(to, 0.0, 0.0)], told)


@pytest.fixture
def gateway(monkeypatch: pytest.MonkeyPatch) -> Gateway:
    return Gateway(monkeypatch, area("road", 10, 16), area("pit", 14, 22))


def test_a_goal_that_crosses_places_needs_all_of_them(gateway: Gateway) -> None:
    assert gateway.go(0.0, 40.0) == PlacesNeeded("m", ("pit", "road"))
    assert gateway.go(0.0, 40.0, told=False) == PlacesNeeded("m", ("pit", "road"))
    assert gateway.go(-20.0, -10.0) is None
    assert isinstance(gateway.go(0.0, 59.0), LeavesArea)
    gateway.report(held=["road"])
    assert gateway.go(0.0, 40.0) == PlacesNeeded("m", ("pit",))
    gateway.report(held=["road", "pit"])
    assert gateway.go(0.0, 40.0) is None


def test_it_reports_where_it_is_and_what_it_uses(gateway: Gateway) -> None:
    gateway.look(12.0)
    told = gateway.report(held=["road"])
    assert (sorted(told.places), list(told.inside), told.sure) == (["pit", "road"], ["pit", "road"], True)
    gateway.look(11.0, sure=False)
    told = gateway.report(held=["road"])
    assert (list(told.in_use), list(told.inside), told.sure) == (["pit", "road"], ["pit", "road"], False)


def test_it_reports_at_once_what_the_keeper_waits_for(gateway: Gateway) -> None:
    gateway.look(0.0)
    gateway.report()
    gateway.steps[0]()
    assert len(gateway.sent) == 1, "the next one is due later"
    gateway.watch._heard(Places(places=[Place(name="road", state=Place.GRANTED, holder="m")]))
    gateway.answer = ReportPlaces.Response(lease=LEASE, held=["road"])
    gateway.steps[0]()
    gateway.steps[0]()
    assert [list(one.in_use) for one in gateway.sent[1:]] == [[], ["road"]]


def test_a_place_that_nobody_wants_is_given_back_outside(gateway: Gateway) -> None:
    gateway.report(held=["road"])
    gateway.look(12.0)
    gateway.report(leaving=["road"])
    gateway.look(12.0)
    assert gateway.watch.open == {"road"}
    gateway.look(0.0, drives=True)
    assert gateway.watch.open == {"road"}
    gateway.look(0.0)
    assert gateway.watch.open == frozenset() and list(gateway.report().in_use) == []


def test_what_nobody_wants_any_more_is_no_way_for_the_next_goal(gateway: Gateway) -> None:
    gateway.report(held=["road", "pit"])
    gateway.look(40.0)
    assert gateway.go(0.0, 40.0) is None
    gateway.watch._heard(Places(places=[Place(name="road", state=Place.LEAVING, holder="m")]))
    assert gateway.go(0.0, 40.0) == PlacesNeeded("m", ("road",))
    assert gateway.watch._due == 0.0, "the keeper waits for its word"
    gateway.watch._heard(Places(places=[Place(name="road", state=Place.HELD, holder="m")]))
    assert gateway.go(0.0, 40.0) is None, "it is wanted again"


def test_without_the_keeper_a_lease_ends_and_the_tracks_are_held(gateway: Gateway) -> None:
    gateway.report(held=["road", "pit"])
    gateway.silent = True
    gateway.now += LEASE - 1.0
    gateway.report()
    assert gateway.look(11.0, drives=True, speed=1.0) is None
    gateway.now += 2.0
    assert gateway.look(0.0, drives=True) is None, "it is not there"
    assert gateway.look(7.0, drives=True, speed=1.0) == LeaseOver("m", "road"), "it would come there"
    assert gateway.look(17.0, drives=False) is None
    assert gateway.go(12.0, 40.0) == LeaseOver("m", "pit")
    assert gateway.go(0.0, 40.0) is not None
    gateway.silent = False
    gateway.report(held=["road", "pit"])
    assert gateway.look(11.0, drives=True, speed=1.0) is None and gateway.go(12.0, 40.0) is None


def test_a_revoked_place_is_closed(gateway: Gateway) -> None:
    gateway.report(held=["road"])
    gateway.look(8.0)
    gateway.report(revoked=["road"])
    assert gateway.watch.open == frozenset()
    verdict = gateway.guard(gateway.watch.open).look(Seen(None, Motion(7.0, 0.0, 0.0, 2.0)), {}, tracks=True)
    assert isinstance(verdict.stop, EntersArea)


def test_a_place_that_is_lost_on_the_way_in_is_in_use_until_the_machine_stands(gateway: Gateway) -> None:
    gateway.report(held=["road"])
    for losing in ({"revoked": ["road"]}, {"leaving": ["road"]}):
        gateway.report(**losing)
        for drives in (True, False):
            gateway.look(5.0, drives=drives, speed=2.0)
            assert list(gateway.report(**losing).in_use) == ["road"]
        gateway.now += 2.0
        gateway.look(6.0)
        assert list(gateway.report(held=["road"]).in_use) == []


def test_out_of_one_that_evacuates_it_may_drive_but_not_to_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    gateway = Gateway(monkeypatch, area("road", 10, 40, "evacuate"))
    gateway.report(held=["road"])
    gateway.look(20.0)
    gateway.report(revoked=["road"])
    assert gateway.look(20.0, drives=True, speed=1.0) is None
    assert gateway.go(20.0, 30.0) == OnlyOut("m", "road")
    assert gateway.go(20.0, 50.0) is None
    gateway.look(50.0)
    assert gateway.watch.open == frozenset()
