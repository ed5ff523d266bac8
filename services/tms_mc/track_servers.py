"""The actions that drive tracks, with the messages of Jazzy or of Humble, as built."""

from collections.abc import Callable, Sequence
from typing import Any

from nav2_msgs.action import FollowPath, FollowWaypoints, NavigateThroughPoses, NavigateToPose

from tms_config.clock import sleep
from tms_control.path import told as told_path
from tms_control.trip import Trip
from tms_control.trip_task import Feedback, Missed, Task
from tms_control.verdict import Verdict
from tms_machine.motion_messages import missed_waypoints
from tms_machine.stamps import duration
from tms_mc.goal_poses import in_map, pose_of
from tms_mc.guard import Guard
from tms_mc.surroundings import Surroundings
from tms_mc.tracks import Tracks
from tms_mc.way_teller import WayTeller
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ros.goals import Ended, Outcome
from tms_ros.server import AnyGoal

FEEDBACK = 0.1  # s
FAILED = 1  # error code of a goal


class TrackServers:
    """Serves the navigation of one machine."""

    def __init__(self, tracks: Tracks, guard: Guard, around: Surroundings, ways: WayTeller) -> None:
        self._tracks, self._guard, self._around, self._ways = tracks, guard, around, ways

    def to_pose(self, goal: AnyGoal) -> Ended[Any]:
        """NavigateToPose."""
        pose = pose_of(goal.request.pose)

        def task() -> Task:
            return Task.to(pose, self._around.roads.between(self._tracks.pose, pose))

        return self._drive(goal, NavigateToPose, task, self._progress)

    def through_poses(self, goal: AnyGoal) -> Ended[Any]:
        """NavigateThroughPoses."""
        task = Task.through([pose_of(one) for one in goal.request.poses])
        return self._drive(goal, NavigateThroughPoses, lambda: task, self._progress)

    def waypoints(self, goal: AnyGoal) -> Ended[Any]:
        """FollowWaypoints."""
        task = Task.waypoints([pose_of(one) for one in goal.request.poses])

        def progress(action: Any, told: Feedback) -> Any:
            return action.Feedback(current_waypoint=told.waypoint)

        return self._drive(goal, FollowWaypoints, lambda: task, progress)

    def path(self, goal: AnyGoal) -> Ended[Any]:
        """FollowPath."""
        task = Task.along(told_path([pose_of(one) for one in goal.request.path.poses]))

        def progress(action: Any, told: Feedback) -> Any:
            return action.Feedback(distance_to_goal=told.left, speed=told.speed)

        return self._drive(goal, FollowPath, lambda: task, progress)

    def _drive(
        self, goal: AnyGoal, action: Any, task: Callable[[], Task], progress: Callable[[Any, Feedback], Any]
    ) -> Ended[Any]:
        """`task` is asked once it is known what is around, and the machine stands."""
        with self._guard.working_for(goal):
            if (kept := self._guard.wait(goal)) is not None:
                return Outcome.ABORTED, _result(action, kept, [])
            try:
                self._around.read(self._tracks.pose)
            except SubtaskFailed as error:
                return Outcome.ABORTED, _result(action, error.reason, [])
            trip = self._tracks.begin(task(), self._around.ground())
            goal.on_cancel = lambda: self._tracks.stop(trip)
            if goal.cancelled.is_set():  # the request came before the motion began
                goal.on_cancel()
            while trip.verdict is None and not self._guard.closing:
                sleep(FEEDBACK)
                self._tracks.look(trip, self._around.ground())
                self._ways.tell(trip.way)
                goal.publish(progress(action, self._tracks.told(trip)))
        return _ended(action, goal, trip)

    def _progress(self, action: Any, told: Feedback) -> Any:
        found = action.Feedback(
            current_pose=in_map(told.pose), navigation_time=duration(told.seconds), distance_remaining=told.left,
            estimated_time_remaining=duration(told.seconds_left),
        )  # fmt: skip
        if action is NavigateThroughPoses:
            found.number_of_poses_remaining = told.poses_left
        return found


def _ended(action: Any, goal: AnyGoal, trip: Trip) -> Ended[Any]:
    verdict: Verdict | None = trip.verdict
    if verdict is None:  # this process ends
        return Outcome.ABORTED, action.Result()
    outcome = Outcome.CANCELED if goal.cancelled.is_set() else Outcome[verdict.ending.value]
    return outcome, _result(action, verdict.reason, trip.missed)


def _result(action: Any, why: Reason | None, missed: Sequence[Missed]) -> Any:
    found = action.Result()
    if hasattr(found, "error_code") and why is not None:  # Humble's results have no reason
        found.error_code, found.error_msg = FAILED, to_line(why)
    if action is FollowWaypoints and missed:
        found.missed_waypoints = missed_waypoints([one.number for one in missed])
    return found
