"""Where the bases of machines stand in the map: the one answer to that, for every process.

It comes from the `pose` topic of a machine's border where it has one (OperaSim-PhysX publishes no /tf), else from /tf.
The odometry of the tracks is never asked: it begins at 0 where a machine was switched on, and slipping tracks falsify
its heading; that of simulated machines tells half or a third of each turn.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

from geometry_msgs.msg import Pose, PoseStamped
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

from tms_config.models import Border, Source
from tms_machine.frames import MAP, FramePose, Frames
from tms_machine.geometry import is_orientation, yaw_of
from tms_machine.reasons import NotInMap
from tms_proof.reasons import Old, Unheard
from tms_proof.source import LABELS
from tms_proof.standstill import POSE
from tms_reason.reason import Reason
from tms_ros.node import Ros
from tms_ros.topics import Arrival

PERIOD = 0.2  # s between two calls of `take`: to wake up for each message would be most of an idle console's load
DEPTH = 200  # messages of /tf within PERIOD: as many as ten machines with joints and navigation publish meanwhile
FIXED = 100  # messages of /tf_static, which are published once, by as many processes
IN_MAP = (MAP, "world")  # frames of a pose; `world` is OperaSim-PhysX's name of the map
POSES = {"PoseStamped": PoseStamped, "Odometry": Odometry}  # types of a pose topic


def pose_of(message: PoseStamped | Odometry) -> Pose:
    """The pose in a message of a pose topic."""
    return message.pose.pose if isinstance(message, Odometry) else message.pose


def place_of(message: PoseStamped | Odometry) -> tuple[float, float, float] | None:
    """The place in a message of a pose topic: x [m], y [m], yaw [rad] in the map.

    None in another frame, and for a localisation without a fix: it sends NaN, or no orientation.
    """
    pose = pose_of(message)
    at, q = pose.position, pose.orientation
    turn = (q.x, q.y, q.z, q.w)
    numbers = all(map(math.isfinite, (at.x, at.y, *turn)))
    if message.header.frame_id not in IN_MAP or not numbers or not is_orientation(turn):
        return None
    return at.x, at.y, yaw_of(turn)


def deviation_of(message: PoseStamped | Odometry) -> float:
    """The deviation [m] in a message of a pose topic, along the worst direction; 0: not said, infinite: no number."""
    if not isinstance(message, Odometry):
        return 0.0
    xx, xy, _, _, _, _, _, yy, *_ = message.pose.covariance
    worst = (xx + yy) / 2 + math.hypot((xx - yy) / 2, xy)
    return math.sqrt(worst) if min(xx, yy, worst) >= 0 and math.isfinite(worst) else math.inf


class PoseTopic:
    """The last place that a machine's pose topic has told."""

    def __init__(self, ros: Ros, topic: str, source: Source) -> None:
        self._topic = topic
        self._arrivals: Callable[[], list[Arrival[Any]]] = ros.sample_arrivals(POSES[source.message], topic)
        self._frame = MAP  # of the last message
        self.deviation = 0.0  # m, of the last place
        self.place: FramePose | None = None  # replaced, never changed: other threads read it without a lock

    def take(self) -> bool:
        """Take what has come; whether it told a place."""
        before = self.place
        for arrival in self._arrivals():
            self._frame = arrival.message.header.frame_id
            if (place := place_of(arrival.message)) is not None:
                self.place = FramePose(*place, arrival.received)
                self.deviation = deviation_of(arrival.message)
        return self.place is not before

    def missing(self, now: float, limit: float) -> Reason | None:
        """Why no place younger than `limit` [s] is known at `now` [s, monotonic]; None if one is."""
        if self._frame not in IN_MAP:
            return NotInMap(self._frame, self._topic)
        if self.place is None:
            return Unheard(LABELS[POSE], self._topic)
        age = now - self.place.received
        return Old(LABELS[POSE], age, self._topic) if age > limit else None


class Places:
    """Keeps the last place of every given machine: one without new messages still stands there."""

    def __init__(self, ros: Ros, borders: Mapping[str, Border]) -> None:
        """`borders`: by machine, as `Site.border` gives them."""
        posed = {name: border for name, border in borders.items() if border.pose}
        self._topics = {name: PoseTopic(ros, f"/{name}/{one.pose}", one.sources["pose"]) for name, one in posed.items()}
        self._bases = {name: border.base_frame for name, border in borders.items() if name not in posed}
        self._frames = Frames(self._bases.values())
        if self._bases:
            self._new_frames = ros.sample(TFMessage, "/tf", DEPTH)
            ros.subscribe(TFMessage, "/tf_static", self._frames.receive_fixed, depth=FIXED, latched=True)

    def take(self) -> set[str]:
        """Take what has come; returns the machines that it tells of. For one thread, every PERIOD."""
        told = {name for name, topic in self._topics.items() if topic.take()}
        moved = set[str]().union(*map(self._frames.receive, self._new_frames())) if self._bases else set[str]()
        return told | {name for name, base in self._bases.items() if base in moved}

    def place(self, machine: str) -> FramePose | None:
        """Where the base of a machine was last told to be; None if it never was."""
        topic = self._topics.get(machine)
        return topic.place if topic is not None else self._frames.place(self._bases[machine])

    def deviation(self, machine: str) -> float:
        """The deviation [m] that the last place of a machine was told with; 0: it was told without."""
        topic = self._topics.get(machine)
        return 0.0 if topic is None else topic.deviation

    def missing(self, machine: str, now: float, limit: float) -> Reason | None:
        """Why the pose topic of a machine tells no place younger than `limit` [s] at `now` [s, monotonic].

        None if it does, and for a machine without such a topic: who listens to /tf cannot know whether one will come.
        """
        topic = self._topics.get(machine)
        return None if topic is None else topic.missing(now, limit)
