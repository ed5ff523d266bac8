"""The sensing PC: publishes where to dig, and measures how soon a subtask could read it."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any

from verify.place import MACHINE, Place, until

if TYPE_CHECKING:
    from tms_ros.node import Ros

RECORD = "target_excavate_pose"
TOPIC = "/tms_sp_excavate_simple"
PLACES = [(0.1 + 0.08 * step, -4.65) for step in range(11)]  # m in base_link; the last is where it digs
UNREACHABLE = (60.0, -60.0)
SOON = 0.5  # s in which a value must be readable
LIMIT = 20.0  # s for whatever must happen at all


class Sensing:
    """A node beside the mesh."""

    def __init__(self, ros: Ros) -> None:
        from sensing_msgs.msg import ExcavateSimple
        from tms_msg_db.srv import GetParameter

        self._ros, self._message, self._get = ros, ExcavateSimple, GetParameter
        self._publisher = ros.publisher(ExcavateSimple, TOPIC)

    def wait_ready(self) -> None:
        """Until somebody hears it."""
        until(lambda: self._publisher.get_subscription_count() > 0, LIMIT, "tms:sp hears the sensing PC")
        until(lambda: self._ros.has_service(self._get, "/tms/db/get_parameter"), LIMIT, "the database answers")

    def read(self) -> dict[str, Any]:
        """The record, as a subtask reads it."""
        from tms_machine.values import from_parameters

        request = self._get.Request(model_name=MACHINE, record_name=RECORD, max_age=-1.0)
        return dict(from_parameters(self._ros.call(self._get, "/tms/db/get_parameter", request, LIMIT).record.values))

    def renew(self, place: tuple[float, float]) -> float:
        """Publish a place to dig; how long until it could be read [s]."""
        begun = time.monotonic()
        x, y = place
        self._publisher.publish(self._message(model_name=MACHINE, record_name=RECORD, x=x, y=y, z=0.1016, theta_w=0.0))
        until(lambda: (self.read()["x"], self.read()["y"]) == place, LIMIT, f"{RECORD} is {place}")
        return time.monotonic() - begun


def swing(place: Place, x: float, y: float) -> float:
    """Swing angle [rad] that brings the bucket over a place in base_link: the arm is beside the swing axis."""
    geometry = place.site.model_of(MACHINE).geometry
    axis = geometry["swing_joint"].xyz
    aside = sum(geometry[name].xyz[1] for name in ("boom_joint", "arm_joint", "bucket_joint"))
    dx, dy = x - axis[0], y - axis[1]
    return math.atan2(dy, dx) - math.asin(aside / math.hypot(dx, dy))
