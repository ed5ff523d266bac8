"""Capability of machines that travel: goals for Nav2, in the frame `map`."""

from collections.abc import Sequence

from geometry_msgs.msg import Pose, PoseStamped
from nav2_msgs.action import FollowWaypoints, NavigateThroughPoses, NavigateToPose

from tms_machine.acting import Acting, Progress, missed
from tms_machine.frames import MAP
from tms_reason.errors import SubtaskFailed


class Driving(Acting):
    """Tracks and a navigation that knows the way."""

    def navigate_to(self, progress: Progress, pose: Pose) -> None:
        """Drive to a pose and stand there."""
        goal = NavigateToPose.Goal(pose=self._stamped(pose))
        self.guarded("navigate_to_pose", NavigateToPose, goal, lambda f: progress(_left(f)))

    def navigate_through(self, progress: Progress, poses: Sequence[Pose]) -> None:
        """Drive through poses without a stop, and stand at the last."""

        def heard(feedback: NavigateThroughPoses.Feedback) -> None:
            progress(f"{_left(feedback)}, {feedback.number_of_poses_remaining} poses to go")

        goal = NavigateThroughPoses.Goal(poses=[self._stamped(pose) for pose in poses])
        self.guarded("navigate_through_poses", NavigateThroughPoses, goal, heard)

    def follow(self, progress: Progress, poses: Sequence[Pose]) -> None:
        """Drive from one pose to the next, standing at each.

        Raises:
            SubtaskFailed: MISSED_WAYPOINTS, also when the navigation itself calls that a success.
        """

        def heard(feedback: FollowWaypoints.Feedback) -> None:
            progress(f"DRIVING to waypoint {feedback.current_waypoint} of 0..{len(poses) - 1}")

        goal = FollowWaypoints.Goal(poses=[self._stamped(pose) for pose in poses])
        result = self.guarded("follow_waypoints", FollowWaypoints, goal, heard)
        lost = missed(result)
        if lost:
            places = ", ".join(f"{i} ({poses[i].position.x:.2f}, {poses[i].position.y:.2f})" for i in lost)
            raise SubtaskFailed("MISSED_WAYPOINTS", f"{self.name} did not reach waypoint {places}")

    def _stamped(self, pose: Pose) -> PoseStamped:
        stamped = PoseStamped(pose=pose)
        stamped.header.frame_id, stamped.header.stamp = MAP, self._ros.now()
        return stamped


def _left(feedback: NavigateToPose.Feedback | NavigateThroughPoses.Feedback) -> str:
    return f"DRIVING {feedback.distance_remaining:.1f} m to go"
