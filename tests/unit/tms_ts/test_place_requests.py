"""What runs want of places is told in order, and again until the keeper answers."""

import threading
from types import SimpleNamespace
from typing import Any

import pytest
import structlog
from tms_msg_areas.msg import Place, PlaceRequest, Places
from tms_msg_areas.srv import AskPlaces

from tms_places.reasons import NoPlace
from tms_reason.errors import RosError
from tms_ros.reasons import NoServer
from tms_ts import place_requests
from tms_ts.place_requests import PlaceRequests, RunPlaces


class Keeper:
    """Is away for the first calls, and knows one place."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, away: int = 0) -> None:
        self.away, self.heard = away, list[Any]()
        self.tell: Any = None  # what the keeper tells
        monkeypatch.setattr(place_requests, "ask", self._ask)
        monkeypatch.setattr(place_requests, "ASK_AGAIN", 0.0)
        self.steps: list[Any] = []
        ros = SimpleNamespace(
            poll_in_thread=lambda _period, step, _name: self.steps.append(step),
            subscribe=lambda _type, _name, heard, **_: setattr(self, "tell", heard),
        )
        self.app: Any = SimpleNamespace(ros=ros, stopping=threading.Event(), log=structlog.get_logger())
        self.requests = PlaceRequests(self.app, lambda: ["interrupted"], lambda run: not run.endswith("-east"))

    def _ask(self, _ros: Any, _kind: Any, name: str, request: Any, _limit: float) -> Any:
        self.away -= 1
        if self.away >= 0:
            raise RosError(NoServer("tms:db", name, 3.0))
        if "rood" in request.places:
            raise RosError(NoPlace("rood", ("road",)), "NO_PLACE")
        self.heard.append(request)
        return AskPlaces.Response(revision=len(self.heard))

    def send(self) -> None:
        self.steps[0]()


def test_requests_reach_a_keeper_that_was_away_in_their_order(monkeypatch: pytest.MonkeyPatch) -> None:
    keeper, woken = Keeper(monkeypatch, away=3), list[int]()
    run = RunPlaces(keeper.requests, "run-1", lambda: woken.append(1))
    held, freed = run.hold("a", "road"), run.free("a", "road")
    assert not held.done
    keeper.send()
    assert held.done and freed.done and held.error is None and woken
    assert [(one.machine, one.run, list(one.places), one.hold) for one in keeper.heard] == [
        ("a", "run-1", ["road"], True), ("a", "run-1", ["road"], False)
    ]  # fmt: skip


def test_a_refusal_is_the_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    keeper = Keeper(monkeypatch)
    answer = RunPlaces(keeper.requests, "run-1", lambda: None).hold("a", "rood")
    keeper.send()
    assert answer.error == NoPlace("rood", ("road",)) and not keeper.heard


def test_a_run_that_is_over_wants_nothing_nor_do_goals_of_its_machines(monkeypatch: pytest.MonkeyPatch) -> None:
    keeper, woken = Keeper(monkeypatch), list[int]()
    run = RunPlaces(keeper.requests, "run-1", lambda: woken.append(1))
    keeper.requests._changed()
    run.close(["a", "b"])
    keeper.requests._changed()
    keeper.send()
    assert len(woken) == 1, "it looks at places no more"
    assert [(one.machine, one.run, one.hold) for one in keeper.heard] == [
        ("", "run-1", False), ("a", "", False), ("b", "", False)
    ]  # fmt: skip


def test_what_a_run_wanted_that_ended_under_an_earlier_scheduler_is_freed(monkeypatch: pytest.MonkeyPatch) -> None:
    keeper = Keeper(monkeypatch)
    RunPlaces(keeper.requests, "new", lambda: None).hold("b", "road")
    keeper.send()
    queue = [PlaceRequest(machine="b", run="new"), PlaceRequest(machine="c", run="ended too")]
    held = [Place(name="road", holder="a", run="ended", queue=queue), Place(name="yard", holder="d", run="interrupted"),
            Place(name="gate", holder="e"), Place(name="hall", holder="f", run="other's-east")]  # fmt: skip
    keeper.tell(Places(revision=1, places=held))
    keeper.send()
    keeper.tell(Places(revision=2, places=held))
    keeper.send()
    assert [(one.machine, one.run, one.hold) for one in keeper.heard] == [
        ("b", "new", True), ("", "ended", False), ("", "ended too", False)
    ]  # fmt: skip
