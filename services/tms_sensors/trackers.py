"""Hears the trackers of a site, directly: no other process is between their topics and a gateway."""

import math
from collections.abc import Callable, Mapping
from typing import Any

from geometry_msgs.msg import PointStamped, PoseArray, PoseStamped
from std_msgs.msg import Bool

from tms_areas.areas import Point
from tms_areas.intruders import Intruders
from tms_areas.reasons import ManyIntruders, NotInMapFrame, PlaceNoNumber, TrackerClockAhead
from tms_areas.trackers import Tracker
from tms_config.clock import monotonic, unix_time
from tms_machine import stamps
from tms_machine.frames import MAP
from tms_reason.errors import TmsError
from tms_ros.node import Ros
from tms_ros.topics import Arrival

TYPES = {"geometry_msgs/msg/PoseArray": PoseArray, "geometry_msgs/msg/PoseStamped": PoseStamped,
         "geometry_msgs/msg/PointStamped": PointStamped, "std_msgs/msg/Bool": Bool}  # fmt: skip
DEPTH = 50  # messages that may come between two looks: that a gate was open for a moment must not be lost
MOST = 500  # places in a message; more are a mistake, and would take their time
AHEAD = 0.5  # s that the clock of a tracker may be ahead of ours


class Hearing:
    """The trackers of a site, for one thread."""

    def __init__(self, ros: Ros, trackers: Mapping[str, Tracker]) -> None:
        self.intruders = Intruders(trackers, monotonic())
        self._inputs = {name: _arrivals(ros, given) for name, given in trackers.items()}

    def take(self) -> Intruders:
        """Take what has come since the last call."""
        for name, take_new in self._inputs.items():
            for arrival in take_new():
                self._take(name, arrival)
        return self.intruders

    def _take(self, name: str, arrival: Arrival[Any]) -> None:
        message = arrival.message
        if isinstance(message, Bool):
            self.intruders.gate(name, arrival.received, message.data)
            return
        try:
            self.intruders.seen(name, arrival.received - age_of(message, unix_time()), places_of(message))
        except TmsError as error:
            self.intruders.unreadable(name, error.reason)


def age_of(message: PoseArray | PoseStamped | PointStamped, now: float) -> float:
    """How long before its arrival it was measured [s]; 0 without a stamp. `now`: s since 1970.

    Raises:
        TmsError: it was measured later than now.
    """
    stamp = stamps.seconds(message.header.stamp)
    if stamp - now > AHEAD:
        raise TmsError(TrackerClockAhead(stamp - now))
    return max(0.0, now - stamp) if stamp else 0.0


def places_of(message: PoseArray | PoseStamped | PointStamped) -> list[Point]:
    """Where it says that somebody is [m, map].

    Raises:
        TmsError: another frame, what is not a number, or more than MOST places.
    """
    if message.header.frame_id != MAP:
        raise TmsError(NotInMapFrame(message.header.frame_id))
    if isinstance(message, PoseArray):
        if len(message.poses) > MOST:
            raise TmsError(ManyIntruders(len(message.poses), MOST))
        found = [(one.position.x, one.position.y) for one in message.poses]
    else:
        at = message.pose.position if isinstance(message, PoseStamped) else message.point
        found = [(at.x, at.y)]
    if not all(math.isfinite(number) for place in found for number in place):
        raise TmsError(PlaceNoNumber())
    return found


def _arrivals(ros: Ros, given: Tracker) -> Callable[[], list[Arrival[Any]]]:
    best_effort = given.reliability == "best_effort"
    return ros.sample_arrivals(TYPES[given.type], given.topic, DEPTH, best_effort=best_effort)
