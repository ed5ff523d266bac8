"""Capability of machines that travel: goals for Nav2, in the frame `map`."""

from collections.abc import Callable, Sequence

from geometry_msgs.msg import Pose, PoseStamped
from nav2_msgs.action import ComputePathToPose, FollowPath, FollowWaypoints, NavigateThroughPoses, NavigateToPose
from nav_msgs.msg import Path

from tms_config.clock import monotonic
from tms_interfaces.generated import ActionType, F, G, R
from tms_kit.acting import Acting, Progress, missed
from tms_kit.place_holding import holding
from tms_machine.frames import MAP
from tms_machine.reasons import Driving, DrivingThrough, DrivingTo, MissedWaypoints, NoCapability, PathEmpty, Waypoint
from tms_places.reasons import PlacesNeeded
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason


class Navigating(Acting):
    """Tracks and a navigation."""

    def navigate_to(self, progress: Progress, pose: Pose) -> None:
        """Drive to a pose and stand there."""
        goal = NavigateToPose.Goal(pose=self._stamped(pose))

        def received(feedback: NavigateToPose.Feedback) -> None:
            progress(Driving(feedback.distance_remaining))

        self._drive(progress, "navigate_to_pose", NavigateToPose, goal, received)

    def navigate_through(self, progress: Progress, poses: Sequence[Pose]) -> None:
        """Drive through poses without a stop, and stand at the last."""

        def received(feedback: NavigateThroughPoses.Feedback) -> None:
            progress(DrivingThrough(feedback.distance_remaining, feedback.number_of_poses_remaining))

        goal = NavigateThroughPoses.Goal(poses=[self._stamped(pose) for pose in poses])
        self._drive(progress, "navigate_through_poses", NavigateThroughPoses, goal, received)

    def follow(self, progress: Progress, poses: Sequence[Pose]) -> None:
        """Drive from one pose to the next, standing at each.

        Raises:
            SubtaskFailed: MissedWaypoints, also when the navigation itself calls that a success.
        """

        def received(feedback: FollowWaypoints.Feedback) -> None:
            progress(DrivingTo(feedback.current_waypoint, len(poses) - 1))

        goal = FollowWaypoints.Goal(poses=[self._stamped(pose) for pose in poses])
        result = self._drive(progress, "follow_waypoints", FollowWaypoints, goal, received)
        lost = missed(result)
        if lost:
            places = tuple(Waypoint(i, poses[i].position.x, poses[i].position.y) for i in lost)
            raise SubtaskFailed(MissedWaypoints(self.name, places))

    def compute_path(self, progress: Progress, goal: Pose) -> list[Pose]:
        """A path from where the machine is to a pose; nothing moves.

        Raises:
            SubtaskFailed: NoCapability, PathEmpty, or as every goal.
        """
        # It moves nothing, so the gateway does not serve it; its name is the same at every border that has it.
        names = [border.compute_path_to_pose for border in self.model.borders.values() if border.compute_path_to_pose]
        if not names:
            raise SubtaskFailed(NoCapability(self.name, "compute_path_to_pose", self._model_name))
        asked = ComputePathToPose.Goal(goal=self._stamped(goal))
        found = self.act(ComputePathToPose, names[0], asked).path.poses
        if not found:
            raise SubtaskFailed(PathEmpty())
        return [stamped.pose for stamped in found]

    def follow_path(self, progress: Progress, poses: Sequence[Pose]) -> None:
        """Drive along a path and stand at its end."""
        path = Path(poses=[self._stamped(pose) for pose in poses])
        path.header.frame_id = MAP
        goal = FollowPath.Goal(path=path)
        self._drive(progress, "follow_path", FollowPath, goal, lambda f: progress(Driving(f.distance_to_goal)))

    def _drive(
        self, progress: Progress, field: str, action_type: ActionType[G, R, F], goal: G, received: Callable[[F], None]
    ) -> R:
        """`guarded`; a goal that crosses shared places is sent again once the machine holds them.

        Time that the machine waits for others is not taken from the subtask.
        """
        try:
            return self.guarded(field, action_type, goal, received)
        except SubtaskFailed as error:
            needed = error.reason.find(PlacesNeeded)
            if needed is None:
                raise
        left = self._deadline - monotonic()

        def waits(why: Reason) -> None:
            progress(why)
            self._deadline = monotonic() + left
            self.check()

        with holding(self._ros, self.yard.shared, self.name, needed.places, waits):
            return self.guarded(field, action_type, goal, received)

    def _stamped(self, pose: Pose) -> PoseStamped:
        stamped = PoseStamped(pose=pose)
        stamped.header.frame_id, stamped.header.stamp = MAP, self._ros.now()
        return stamped
