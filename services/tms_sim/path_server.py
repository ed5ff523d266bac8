"""ComputePathToPose of a stand-in: straight to the goal, on ground without obstacles. It moves nothing."""

import math
from typing import Any

from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import ComputePathToPose
from nav_msgs.msg import Path

from tms_machine.frames import MAP
from tms_machine.geometry import about
from tms_ros.goals import Ended, Outcome
from tms_ros.server import AnyGoal
from tms_sim.navigator import Navigator

STEP = 0.5  # m between poses of a path


class PathServer:
    """Answers goals at once."""

    def __init__(self, navigator: Navigator) -> None:
        self._navigator = navigator

    def run(self, goal: AnyGoal) -> Ended[Any]:
        """A path from the goal's start, or from where the machine is."""
        request = goal.request
        here = self._navigator.base.x, self._navigator.base.y
        start = request.start.pose.position
        begin = (start.x, start.y) if request.use_start else here
        return Outcome.SUCCEEDED, ComputePathToPose.Result(path=straight(begin, request.goal))


def straight(begin: tuple[float, float], goal: PoseStamped) -> Path:
    """Poses from `begin` [m] to the goal, each in the direction of the way; the last is the goal."""
    end = goal.pose.position.x, goal.pose.position.y
    yaw, count = math.atan2(end[1] - begin[1], end[0] - begin[0]), math.ceil(math.dist(begin, end) / STEP)
    path = Path()
    for number in range(count):
        one, share = PoseStamped(), number / count
        one.pose.position.x, one.pose.position.y = (a + (b - a) * share for a, b in zip(begin, end, strict=True))
        _, _, one.pose.orientation.z, one.pose.orientation.w = about("z", yaw)
        path.poses.append(one)
    path.poses.append(PoseStamped(pose=goal.pose))
    return in_map(path)


def in_map(path: Path) -> Path:
    """The same path, in the frame `map`."""
    for header in (path.header, *(pose.header for pose in path.poses)):
        header.frame_id = MAP
    return path
