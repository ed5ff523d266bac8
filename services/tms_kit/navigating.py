"""Capability of machines that travel: goals for Nav2, in the frame `map`."""

from collections.abc import Sequence

from geometry_msgs.msg import Pose, PoseStamped
from nav2_msgs.action import FollowWaypoints, NavigateThroughPoses, NavigateToPose

from tms_kit.acting import Acting, Progress, missed
from tms_machine.frames import MAP
from tms_machine.reasons import Driving, DrivingThrough, DrivingTo, MissedWaypoints, Waypoint
from tms_reason.errors import SubtaskFailed


class Navigating(Acting):
    """Tracks and a navigation."""

    def navigate_to(self, progress: Progress, pose: Pose) -> None:
        """Drive to a pose and stand there."""
        goal = NavigateToPose.Goal(pose=self._stamped(pose))
        self.guarded("navigate_to_pose", NavigateToPose, goal, lambda f: progress(Driving(f.distance_remaining)))

    def navigate_through(self, progress: Progress, poses: Sequence[Pose]) -> None:
        """Drive through poses without a stop, and stand at the last."""

        def received(feedback: NavigateThroughPoses.Feedback) -> None:
            progress(DrivingThrough(feedback.distance_remaining, feedback.number_of_poses_remaining))

        goal = NavigateThroughPoses.Goal(poses=[self._stamped(pose) for pose in poses])
        self.guarded("navigate_through_poses", NavigateThroughPoses, goal, received)

    def follow(self, progress: Progress, poses: Sequence[Pose]) -> None:
        """Drive from one pose to the next, standing at each.

        Raises:
            SubtaskFailed: MissedWaypoints, also when the navigation itself calls that a success.
        """

        def received(feedback: FollowWaypoints.Feedback) -> None:
            progress(DrivingTo(feedback.current_waypoint, len(poses) - 1))

        goal = FollowWaypoints.Goal(poses=[self._stamped(pose) for pose in poses])
        result = self.guarded("follow_waypoints", FollowWaypoints, goal, received)
        lost = missed(result)
        if lost:
            places = tuple(Waypoint(i, poses[i].position.x, poses[i].position.y) for i in lost)
            raise SubtaskFailed(MissedWaypoints(self.name, places))

    def _stamped(self, pose: Pose) -> PoseStamped:
        stamped = PoseStamped(pose=pose)
        stamped.header.frame_id, stamped.header.stamp = MAP, self._ros.now()
        return stamped
