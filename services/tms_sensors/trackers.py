"""Hears the trackers of a site, directly: no other process is between their topics and a gateway.

Of those that tell in a record, the database is asked. One that does not answer makes them silent.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

from geometry_msgs.msg import PointStamped, PoseArray, PoseStamped
from std_msgs.msg import Bool

from tms_areas.areas import Point
from tms_areas.intruders import Intruders
from tms_areas.reasons import ManyIntruders, NotInMapFrame, PlaceNoNumber
from tms_areas.trackers import Tracker
from tms_config.clock import monotonic, unix_time
from tms_machine import stamps
from tms_machine.frames import MAP
from tms_reason.errors import TmsError
from tms_ros.node import Ros
from tms_ros.topics import Arrival
from tms_sensors.tracker_records import Told, TrackerRecords, age_since

TYPES = {"geometry_msgs/msg/PoseArray": PoseArray, "geometry_msgs/msg/PoseStamped": PoseStamped,
         "geometry_msgs/msg/PointStamped": PointStamped, "std_msgs/msg/Bool": Bool}  # fmt: skip
DEPTH = 50  # messages that may come between two looks: that a gate was open for a moment must not be lost
MOST = 500  # places in a message; more are a mistake, and would take their time


class Hearing:
    """The trackers of a site, for one thread."""

    def __init__(self, ros: Ros, trackers: Mapping[str, Tracker]) -> None:
        self.intruders = Intruders(trackers, monotonic())
        self._inputs = {name: _arrivals(ros, given) for name, given in trackers.items() if given.topic}
        self._records = TrackerRecords(ros, {name: given for name, given in trackers.items() if given.record})

    def take(self) -> Intruders:
        """Take what has come since the last call."""
        for name, take_new in self._inputs.items():
            for arrival in take_new():
                self._take(name, arrival)
        for told in self._records.take():
            self._take_record(told)
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

    def _take_record(self, told: Told) -> None:
        try:
            measured = told.received - told.age()
            if self.intruders.told[told.tracker].given.kind == "gate":
                self.intruders.gate(told.tracker, measured, told.opened())
            else:
                self.intruders.seen(told.tracker, measured, checked(told.places()))
        except TmsError as error:
            self.intruders.unreadable(told.tracker, error.reason)


def age_of(message: PoseArray | PoseStamped | PointStamped, now: float) -> float:
    """How long before its arrival it was measured [s]; 0 without a stamp. `now`: s since 1970.

    Raises:
        TmsError: it was measured later than now.
    """
    return age_since(stamps.seconds(message.header.stamp), now)


def places_of(message: PoseArray | PoseStamped | PointStamped) -> list[Point]:
    """Where it says that somebody is [m, map].

    Raises:
        TmsError: another frame, what is not a number, or more than MOST places.
    """
    if message.header.frame_id != MAP:
        raise TmsError(NotInMapFrame(message.header.frame_id))
    if isinstance(message, PoseArray):
        return checked([(one.position.x, one.position.y) for one in message.poses])
    at = message.pose.position if isinstance(message, PoseStamped) else message.point
    return checked([(at.x, at.y)])


def checked(places: list[Point]) -> list[Point]:
    """The same places.

    Raises:
        TmsError: one is not a number, or there are more than MOST.
    """
    if len(places) > MOST:
        raise TmsError(ManyIntruders(len(places), MOST))
    if not all(math.isfinite(number) for place in places for number in place):
        raise TmsError(PlaceNoNumber())
    return places


def _arrivals(ros: Ros, given: Tracker) -> Callable[[], list[Arrival[Any]]]:
    best_effort = given.reliability == "best_effort"
    return ros.sample_arrivals(TYPES[given.type], given.topic, DEPTH, best_effort=best_effort)
