"""Stand-ins of trackers: people walk to and fro, and each type of message tells it."""

import pytest
from geometry_msgs.msg import PointStamped, PoseArray, PoseStamped
from std_msgs.msg import Bool, Header

from tms_areas.trackers import Tracker
from tms_config.site_file import TrackerStandIn, Walk
from tms_sensors.trackers import places_of
from tms_sim.trackers import messages, place_on

WALK = Walk(path=((0, 0), (3, 0), (3, 4)), speed=1.0, after=2.0)
MAP = Header(frame_id="map")


@pytest.mark.parametrize(
    ("passed", "place"),
    [(0, (0, 0)), (2, (0, 0)), (3.5, (1.5, 0)), (6, (3, 1)), (9, (3, 4)), (10, (3, 3)), (16, (0, 0)), (17, (1, 0))],
)
def test_somebody_walks_to_and_fro(passed: float, place: tuple[float, float]) -> None:
    assert place_on(WALK, passed) == pytest.approx(place)


@pytest.mark.parametrize(
    "walk", [Walk(path=((1, 2),)), Walk(path=((1, 2), (1, 2))), Walk(path=((1, 2), (5, 2)), speed=0)]
)
def test_somebody_who_stands_stays(walk: Walk) -> None:
    assert place_on(walk, 7.0) == (1, 2)


@pytest.mark.parametrize("kind", [PoseArray, PoseStamped, PointStamped])
def test_a_gateway_understands_what_they_tell(kind: type) -> None:
    given = Tracker(kind="person", topic="eye", type=f"geometry_msgs/msg/{kind.__name__}")
    (message,) = messages(given, TrackerStandIn(walks=(WALK,)), 3.5, MAP)
    assert isinstance(message, kind) and places_of(message) == [(1.5, 0.0)]
    assert len(messages(given, TrackerStandIn(), 3.5, MAP)) == (kind is PoseArray)


def test_a_gate_tells_in_its_own_way() -> None:
    for opened in (True, False):
        given = Tracker(kind="gate", topic="gate", type="std_msgs/msg/Bool", areas=("yard",), opened=opened)
        assert messages(given, TrackerStandIn(open=True), 0.0, MAP) == [Bool(data=opened)]
        assert messages(given, TrackerStandIn(), 0.0, MAP) == [Bool(data=not opened)]
