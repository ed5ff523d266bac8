"""Messages of trackers: what they say, how old it is, and what is no message of ours."""

import math
from collections.abc import Callable
from typing import Any

import pytest
from geometry_msgs.msg import Point, PointStamped, Pose, PoseArray, PoseStamped
from std_msgs.msg import Bool, Header

from tms_areas.reasons import ManyIntruders, NotInMapFrame, PlaceNoNumber, TrackerClockAhead
from tms_areas.trackers import Tracker
from tms_config.clock import monotonic
from tms_machine import stamps
from tms_reason.errors import TmsError
from tms_ros.topics import Arrival
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
