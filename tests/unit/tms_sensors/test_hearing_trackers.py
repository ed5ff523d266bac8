"""Messages of trackers: what they say, how old it is, and what is no message of ours."""

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from geometry_msgs.msg import Point, PointStamped, Pose, PoseArray, PoseStamped
from pydantic import ValidationError
from std_msgs.msg import Bool, Header
from tms_msg_db.msg import Record

from tms_areas.reasons import (
    ManyIntruders,
    NoSwitch,
    NotInMapFrame,
    PlaceNoNumber,
    PlacesUneven,
    TopicOrRecord,
    TrackerClockAhead,
)
from tms_areas.trackers import Tracker
from tms_config.clock import monotonic, unix_time
from tms_machine import stamps
from tms_machine.values import to_parameters
from tms_reason.errors import RosError, TmsError
from tms_reason.validation import explain
from tms_ros.reasons import NoServer
from tms_ros.topics import Arrival
from tms_sensors import tracker_records
from tms_sensors.trackers import MOST, Hearing, age_of, places_of

MAP = Header(frame_id="map")


def array(*places: tuple[float, float], frame: str = "map") -> PoseArray:
    poses = [Pose(position=Point(x=x, y=y)) for x, y in places]
    return PoseArray(header=Header(frame_id=frame), poses=poses)


def test_all_types_tell_places() -> None:
    assert places_of(array()) == []
    assert places_of(array((1.0, 2.0), (3.0, 4.0))) == [(1.0, 2.0), (3.0, 4.0)]
    assert places_of(PoseStamped(header=MAP, pose=Pose(position=Point(x=1.0, y=2.0)))) == [(1.0, 2.0)]
    assert places_of(PointStamped(header=MAP, point=Point(x=1.0, y=2.0))) == [(1.0, 2.0)]


@pytest.mark.parametrize(
    ("message", "why"),
    [
        (array((1.0, 2.0), frame="camera"), NotInMapFrame("camera")),
        (array((1.0, math.nan)), PlaceNoNumber()),
        (array(*[(0.0, 0.0)] * (MOST + 1)), ManyIntruders(MOST + 1, MOST)),
    ],
)
def test_what_cannot_be_used_is_refused(message: PoseArray, why: object) -> None:
    with pytest.raises(TmsError) as error:
        places_of(message)
    assert error.value.reason == why


def test_an_age_comes_from_the_stamp() -> None:
    message = PointStamped(header=Header(frame_id="map", stamp=stamps.time(1000.0)))
    assert age_of(message, 1000.7) == pytest.approx(0.7)
    assert age_of(message, 999.8) == 0.0  # clocks of two PCs
    with pytest.raises(TmsError) as error:
        age_of(message, 990.0)
    assert error.value.reason == TrackerClockAhead(10.0)
    assert age_of(PointStamped(header=MAP), 1000.0) == 0.0


class Ros:
    """Topics whose messages the test puts there."""

    def __init__(self) -> None:
        self.waiting: dict[str, list[Any]] = {}

    def sample_arrivals(self, _type: Any, topic: str, _depth: int, best_effort: bool) -> Callable[[], list[Any]]:
        self.waiting[topic] = []

        def take() -> list[Any]:
            found = [Arrival(message, monotonic(), 0) for message in self.waiting[topic]]
            self.waiting[topic].clear()
            return found

        return take


def test_a_gate_that_was_open_between_two_looks_is_heard() -> None:
    gate = Tracker(kind="gate", topic="gate", type="std_msgs/msg/Bool", areas=("yard",))
    ros: Any = Ros()
    hearing = Hearing(ros, {"gate": gate, "eye": Tracker(kind="person", topic="eye")})
    ros.waiting["gate"] += [Bool(data=False), Bool(data=True), Bool(data=False)]
    ros.waiting["eye"] += [array((1.0, 2.0)), array((1.0, math.nan))]
    told = hearing.take().told
    assert told["gate"].passed and not told["gate"].opened
    assert told["eye"].wrong == PlaceNoNumber() and told["eye"].places.tolist() == [[1.0, 2.0]]


class Records:
    """A database whose records the test makes, and whose reader is the test."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.fields: dict[str, Any] = {}
        self.updated, self.away, self.step = unix_time(), False, lambda: None
        monkeypatch.setattr(tracker_records, "ask", self._ask)

    def poll_in_thread(self, _period: float, step: Callable[[], None], _name: str) -> None:
        self.step = step

    def _ask(self, _ros: Any, _kind: Any, _name: str, request: Any, _limit: float) -> Any:
        if self.away:
            raise RosError(NoServer("tms:db", "/tms/db/get_parameter", 1.0))
        assert (request.model_name, request.max_age) == ("", -1.0)
        values = to_parameters(self.fields[request.record_name])
        return SimpleNamespace(record=Record(values=values, updated_at=stamps.time(self.updated)))


@pytest.fixture
def records(monkeypatch: pytest.MonkeyPatch) -> Records:
    return Records(monkeypatch)


def told_by(records: Any, name: str, fields: dict[str, Any]) -> Any:
    areas = ("yard",) if name == "gate" else ()
    hearing = Hearing(records, {name: Tracker(kind="gate" if areas else "person", record=name, areas=areas)})
    records.fields[name] = fields
    records.step()
    return hearing.take().told[name]


@pytest.mark.parametrize(
    ("fields", "places"),
    [
        ({"x": 1.0, "y": 2.0}, [[1.0, 2.0]]),
        ({"x": [1.0, 3.0], "y": [2, 4]}, [[1.0, 2.0], [3.0, 4.0]]),
        ({"x": [], "y": []}, []),
    ],
)
def test_a_record_tells_places(records: Records, fields: dict[str, Any], places: list[Any]) -> None:
    one = told_by(records, "tags", fields)
    assert one.places.tolist() == places and one.heard and one.wrong is None


@pytest.mark.parametrize(
    ("name", "fields", "why"),
    [
        ("tags", {"x": [1.0], "y": [1.0, 2.0]}, PlacesUneven()),
        ("tags", {"x": 1.0}, PlacesUneven()),
        ("tags", {"x": "1", "y": "2"}, PlacesUneven()),
        ("tags", {"x": math.inf, "y": 1.0}, PlaceNoNumber()),
        ("gate", {"opened": 1}, NoSwitch()),
    ],
)
def test_a_record_that_tells_no_places_is_told(records: Records, name: str, fields: Any, why: Any) -> None:
    assert told_by(records, name, fields).wrong == why


def test_a_gate_tells_by_its_record_and_an_old_one_by_its_time(records: Records) -> None:
    assert told_by(records, "gate", {"opened": True}).opened
    records.updated -= 5.0
    assert monotonic() - told_by(records, "tags", {"x": 1.0, "y": 2.0}).since == pytest.approx(5.0, abs=1.0)
    records.updated += 60.0
    assert isinstance(told_by(records, "tags", {"x": 1.0, "y": 2.0}).wrong, TrackerClockAhead)


def test_a_database_that_is_away_makes_its_tracker_silent(records: Records) -> None:
    records.away = True
    assert not told_by(records, "tags", {"x": 1.0, "y": 2.0}).heard


@pytest.mark.parametrize("given", [{}, {"topic": "people", "record": "people"}])
def test_a_tracker_tells_by_a_topic_or_by_a_record(given: dict[str, str]) -> None:
    with pytest.raises(ValidationError) as error:
        Tracker(kind="person", **given)  # type: ignore[arg-type]
    assert explain(error.value).find(TopicOrRecord) is not None
