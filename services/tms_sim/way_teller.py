"""Tells the way of a stand-in's navigation as Nav2's planner does: from where it is, straight from pose to pose."""

import math

from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path

from tms_machine.border import PLAN
from tms_ros.node import Ros
from tms_sim.base import Base, Leg
from tms_sim.path_server import in_map

EVERY = 25  # ticks, a second


class WayTeller:
    """Of one stand-in."""

    def __init__(self, ros: Ros, machine: str, base: Base) -> None:
        self._plans, self._base = ros.publisher(Path, f"/{machine}/{PLAN}", 1), base
        self._end: Leg | None = None

    def tell(self, tick: int) -> None:
        """Tell it when it begins, and once a second while there is one."""
        legs = list(self._base.legs)
        end = legs[-1] if legs else None
        begins, self._end = end != self._end, end
        if legs and (begins or tick % EVERY == 0):
            places = [(self._base.x, self._base.y), *((leg.x, leg.y) for leg in legs)]
            self._plans.publish(along([place for place in places if all(map(math.isfinite, place))]))


def along(places: list[tuple[float, float]]) -> Path:
    """Places [m] as a path in the map."""
    path = Path(poses=[PoseStamped() for _ in places])
    for pose, (x, y) in zip(path.poses, places, strict=True):
        pose.pose.position.x, pose.pose.position.y, pose.pose.orientation.w = x, y, 1.0
    return in_map(path)
