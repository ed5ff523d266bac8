"""ComputePathToPose: plans the path of the tracks to a pose, and moves nothing."""

from collections.abc import Callable
from typing import Any

from nav2_msgs.action import ComputePathToPose

from tms_config.clock import monotonic
from tms_control.path import Pose
from tms_control.planner import Goal, Plan
from tms_machine import stamps
from tms_mc.goal_poses import in_map_along, pose_of, wrong
from tms_mc.surroundings import Surroundings
from tms_mc.tracks import Tracks
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ros.goals import Ended, Outcome
from tms_ros.server import AnyGoal

STEP = 0.1  # m between poses of a path
FAILED = 200  # nav2_msgs UNKNOWN of this action


class PathServer:
    """Plans as the machine's own goals do, but for the place whose pose is told: that is what FollowPath follows."""

    def __init__(self, tracks: Tracks, around: Surroundings) -> None:
        self._tracks, self._around = tracks, around

    @staticmethod
    def refuse(request: Any) -> Reason | None:
        """Why a goal is refused."""
        return wrong([request.goal, request.start] if request.use_start else [request.goal])

    def run(self, goal: AnyGoal) -> Ended[Any]:
        """Plan from the goal's start, or from where the machine is."""
        begun, request = monotonic(), goal.request
        if not request.use_start and (unknown := self._tracks.unready()) is not None:
            return _failed(unknown)
        start = pose_of(request.start) if request.use_start else self._tracks.pose
        try:
            self._around.read(start)
        except SubtaskFailed as error:
            return _failed(error.reason)
        found = self._way(start, pose_of(request.goal), goal.cancelled.is_set)
        if found is None:
            return Outcome.CANCELED, ComputePathToPose.Result()
        if isinstance(found, Reason):
            return _failed(found)
        took = stamps.duration(monotonic() - begun)
        return Outcome.SUCCEEDED, ComputePathToPose.Result(path=in_map_along(found.path, STEP), planning_time=took)

    def _way(self, start: Pose, goal: Pose, over: Callable[[], bool]) -> Plan | Reason | None:
        """A path along roads, or else any; or why there is none."""
        found: Plan | Reason | None = None
        for passed in dict.fromkeys((self._around.roads.between(start, goal), ())):
            question = self._tracks.question(start, (*passed, Goal(*goal)), self._around.ground())
            found = question.answer(over)
            if not isinstance(found, Reason):
                break
        return found


def _failed(why: Reason) -> Ended[Any]:
    result = ComputePathToPose.Result()
    if hasattr(result, "error_code"):  # Humble's results have no reason
        result.error_code, result.error_msg = FAILED, to_line(why)
    return Outcome.ABORTED, result
