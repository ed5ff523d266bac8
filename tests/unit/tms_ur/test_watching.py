"""Areas, people and hardware reach the API as gateways and trackers tell them."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rcl_interfaces.msg import ParameterValue

from tms_areas.intruders import Intruders
from tms_areas.reasons import APerson, IntruderInside, PlaceNoNumber
from tms_areas.trackers import Tracker
from tms_config.config import load_site
from tms_reason.errors import RosError
from tms_reason.reason import Foreign
from tms_reason.wire import to_line
from tms_ur.board import Board
from tms_ur.watch_models import EnabledAreas, Spot, Watched
from tms_ur.watching import Watching, seen_by

INSIDE = IntruderInside("ic120", APerson(), "yard", "eye", 1.0, 2.0)


class Ros:
    """Topics that the test publishes, and gateways that answer, or not."""

    def __init__(self, **answers: list[str] | None) -> None:
        self.answers, self.heard = answers, dict[str, Any]()

    def subscribe(self, _type: Any, topic: str, take: Any, **_: Any) -> None:
        self.heard[topic] = take

    def sample_arrivals(self, *_: Any, **__: Any) -> Any:
        return list

    def poll_in_thread(self, *_: Any) -> None:
        pass

    def call(self, _type: Any, service: str, _request: Any, _limit: float) -> Any:
        told = self.answers[service.split("/")[1]]
        if told is None:
            raise RosError(Foreign("it is away"))
        return SimpleNamespace(values=[ParameterValue(string_value=one) for one in told])


def watching(folder: Path, ros: Ros, areas: bool = True) -> tuple[Watching, Board]:
    file = folder / "site.yaml"
    machines = "{ic120: {model: ic120}, zx200: {model: zx200, hardware: {alive: {topic: alive}}}}"
    file.write_text(f"{{name: test, domain: 1, sensing: s.yaml, services: {{}}, machines: {machines}}}")
    (folder / "s.yaml").write_text("trackers: {eye: {kind: person, topic: eye}}")
    if areas:
        (folder / "site" / "areas").mkdir(parents=True)
        (folder / "site" / "areas" / "yard.geojson").touch()
    site, board = load_site(str(file)), Board(["ic120", "zx200"])
    made: Any = ros
    return Watching(made, site, board), board


def test_what_gateways_watch_is_on_the_board(tmp_path: Path) -> None:
    ros = Ros()
    _, board = watching(tmp_path, ros)
    changes: list[None] = []
    board.on_change(lambda: changes.append(None))
    people = DiagnosticStatus(name="people", level=DiagnosticStatus.ERROR, message=to_line(INSIDE))
    hardware = DiagnosticStatus(name="hardware", values=[KeyValue(key="alive", value="yes")])
    for _ in range(2):
        ros.heard["/zx200/rc/watches"](DiagnosticArray(status=[people, hardware]))
    assert len(changes) == 1
    ic120, zx200 = board.snapshot().machines
    assert ic120.watched == Watched()
    assert zx200.watched.hardware == {"alive": "yes"} and zx200.watched.people is not None
    assert "a person is in the unmanned area yard" in zx200.watched.people.text.en


def test_without_areas_trackers_are_not_heard(tmp_path: Path) -> None:
    ros = Ros()
    found, _ = watching(tmp_path, ros, areas=False)
    assert list(ros.heard) == ["/zx200/rc/watches"]
    assert found.areas() == EnabledAreas(id=None)


@pytest.mark.parametrize("answer", [None, ["", "", ""]])
def test_areas_come_from_a_gateway_that_knows_them(tmp_path: Path, answer: list[str] | None) -> None:
    document = {"type": "FeatureCollection", "frame": "map", "features": []}
    found, _ = watching(tmp_path, Ros(ic120=answer, zx200=["9f", "a person", json.dumps(document)]))
    assert found.areas() == EnabledAreas(id="9f", by="a person", areas=document)


def test_a_tracker_is_silent_when_it_says_nothing_or_nonsense() -> None:
    site = Intruders({"eye": Tracker(kind="person", topic="eye")}, 0.0)
    told = site.told["eye"]
    assert seen_by("eye", told, 0.1).silent
    site.seen("eye", 0.2, [(1.0, 2.004)])
    shown = seen_by("eye", told, 0.3)
    assert not shown.silent and shown.places == [Spot(x=1.0, y=2.0)]
    assert seen_by("eye", told, 9.0).silent
    site.unreadable("eye", PlaceNoNumber())
    assert seen_by("eye", told, 0.3).silent


def test_the_board_tells_who_is_seen(tmp_path: Path) -> None:
    _, board = watching(tmp_path, Ros())
    site = Intruders({"eye": Tracker(kind="person", topic="eye")}, 0.0)
    changes: list[None] = []
    board.on_change(lambda: changes.append(None))
    seen = [seen_by("eye", site.told["eye"], 0.1)]
    board.put_seen(seen)
    board.put_seen(list(seen))
    assert board.snapshot().seen == seen and len(changes) == 1
