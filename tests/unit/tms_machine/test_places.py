"""Where machines stand: by their pose topic where they have one, else by /tf."""

import math
from typing import Any

import pytest
from geometry_msgs.msg import PoseStamped, TransformStamped
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

from tms_config.models import Border
from tms_machine.places import Places, deviation_of, pose_of
from tms_machine.reasons import NotInMap
from tms_proof.reasons import Old, Pose, Unheard
from tms_ros.topics import Arrival

SOURCE = {"period": 0.06, "stamps": "since_start", "frozen_after": 5.0, "origin": "a test"}
FRESH = 1.0  # s


def border(**given: Any) -> Border:
    return Border.model_validate({"base_frame": "dump/base_link", **given})


BORDERS = {
    "digger": border(pose="base_link/pose", odom="odom", sources={"pose": SOURCE, "odom": SOURCE}),
    "carrier": border(pose="global_pose", sources={"pose": {**SOURCE, "message": "Odometry"}}),
    "dump": border(),
}


def told(kind: Any, x: float, yaw: float, frame: str = "world") -> Any:
    message = kind()
    message.header.frame_id = frame
    pose = pose_of(message)
    pose.position.x, pose.position.y = x, 2.0
    pose.orientation.z, pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return message


def frames(x: float) -> TFMessage:
    one = TransformStamped(child_frame_id="dump/base_link")
    one.header.frame_id, one.transform.translation.x, one.transform.rotation.w = "map", x, 1.0
    return TFMessage(transforms=[one])


class Ros:
    """As much of the node as places use; `coming` has what a topic says next."""

    def __init__(self) -> None:
        self.coming: dict[str, list[Any]] = {}
        self.kinds: dict[str, Any] = {}
        self.now = 10.0

    def sample_arrivals(self, kind: Any, topic: str) -> Any:
        self.kinds[topic] = kind
        return lambda: [Arrival(message, self.now, 1) for message in self.coming.pop(topic, [])]

    def sample(self, kind: Any, topic: str, _depth: int) -> Any:
        self.kinds[topic] = kind
        return lambda: self.coming.pop(topic, [])

    def subscribe(self, kind: Any, topic: str, *_: Any, **__: Any) -> None:
        self.kinds[topic] = kind


def made(ros: Ros, borders: dict[str, Border] = BORDERS) -> Places:
    node: Any = ros
    return Places(node, borders)


def test_each_machine_by_its_own_source() -> None:
    ros = Ros()
    places = made(ros)
    assert places.take() == set() and [places.place(name) for name in BORDERS] == [None] * 3
    ros.coming = {
        "/digger/base_link/pose": [told(PoseStamped, 1.0, 0.5)],
        "/carrier/global_pose": [told(Odometry, 3.0, -0.5, "map")],
        "/tf": [frames(5.0)],
    }
    assert places.take() == {"digger", "carrier", "dump"}
    assert places.place("digger") == pytest.approx((1.0, 2.0, 0.5, 10.0))
    assert places.place("carrier") == pytest.approx((3.0, 2.0, -0.5, 10.0))
    dump = places.place("dump")
    assert dump is not None and dump[:3] == (5.0, 0.0, 0.0)
    assert places.take() == set() and places.place("digger") is not None


def test_the_odometry_of_the_tracks_is_never_asked() -> None:
    ros = Ros()
    made(ros)
    assert ros.kinds == {
        "/digger/base_link/pose": PoseStamped, "/carrier/global_pose": Odometry,
        "/tf": TFMessage, "/tf_static": TFMessage,
    }  # fmt: skip


def test_nobody_listens_to_frames_where_all_machines_have_poses() -> None:
    ros = Ros()
    places = made(ros, {"digger": BORDERS["digger"]})
    assert list(ros.kinds) == ["/digger/base_link/pose"] and places.take() == set()


def test_a_frame_of_a_machine_with_a_pose_topic_is_no_place_of_it() -> None:
    """The driver of a simulated machine may publish frames as wrong as its odometry."""
    ros = Ros()
    both = BORDERS["digger"].model_copy(update={"base_frame": "digger/base_link"})
    places = made(ros, {"digger": both, "dump": BORDERS["dump"]})
    message = frames(9.0)
    message.transforms[0].child_frame_id = "digger/base_link"
    ros.coming = {"/tf": [message]}
    assert places.take() == set() and places.place("digger") is None


def test_a_missing_pose_is_named_with_its_topic() -> None:
    ros = Ros()
    places, topic = made(ros), "/digger/base_link/pose"
    assert places.missing("digger", 10.0, FRESH) == Unheard(Pose(), topic)
    ros.coming = {topic: [told(PoseStamped, 1.0, 0.0)]}
    places.take()
    assert places.missing("digger", 10.5, FRESH) is None
    assert places.missing("digger", 13.0, FRESH) == Old(Pose(), 3.0, topic)
    assert places.missing("dump", 13.0, FRESH) is None  # nobody can know whether /tf will tell it


def test_a_pose_in_another_frame_is_no_place() -> None:
    ros = Ros()
    places, topic = made(ros), "/digger/base_link/pose"
    ros.coming = {topic: [told(PoseStamped, 1.0, 0.0, "digger_tf/odom")]}
    assert places.take() == set() and places.place("digger") is None
    assert places.missing("digger", 10.0, FRESH) == NotInMap("digger_tf/odom", topic)
    ros.coming = {topic: [told(PoseStamped, 1.0, 0.0)]}
    assert places.take() == {"digger"} and places.missing("digger", 10.0, FRESH) is None


@pytest.mark.parametrize(("x", "w"), [(math.nan, 1.0), (math.inf, 1.0), (0.0, math.nan), (0.0, 0.0)])
def test_a_pose_without_numbers_or_orientation_leaves_the_machine_where_it_was(x: float, w: float) -> None:
    ros = Ros()
    places, topic = made(ros), "/digger/base_link/pose"
    bad = told(PoseStamped, x, 0.0)
    bad.pose.orientation.w = w
    ros.coming = {topic: [told(PoseStamped, 7.0, 0.0), bad]}
    assert places.take() == {"digger"}
    place = places.place("digger")
    assert place is not None and place.x == 7.0


def test_the_deviation_of_a_pose_is_that_of_its_worst_direction() -> None:
    message = Odometry()
    assert deviation_of(message) == deviation_of(PoseStamped()) == 0.0
    for (xx, xy, yy), wanted in {
        (0.04, 0.0, 0.01): 0.2, (0.05, 0.04, 0.05): 0.3, (-1.0, 0.0, 0.01): math.inf, (math.nan, 0.0, 0.0): math.inf,
        (0.01, math.inf, 0.01): math.inf,
    }.items():  # fmt: skip
        message.pose.covariance[0] = xx
        message.pose.covariance[1] = message.pose.covariance[6] = xy
        message.pose.covariance[7] = yy
        assert deviation_of(message) == pytest.approx(wanted)
