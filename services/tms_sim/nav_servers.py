"""The navigation's actions, with the messages of Jazzy or of Humble, as built."""

from collections.abc import Callable, Sequence
from typing import Any

from geometry_msgs.msg import Pose, PoseStamped
from nav2_msgs.action import FollowWaypoints, NavigateThroughPoses, NavigateToPose

from tms_machine.frames import MAP
from tms_machine.geometry import about, yaw_of
from tms_machine.motion_messages import missed_waypoints
from tms_machine.stamps import duration
from tms_sim.base import Leg
from tms_sim.machine import StandIn
from tms_sim.motion import MotionVerdict
from tms_sim.navigator import Navigator, Trip
from tms_sim.servers import ActionHandler


def nav_servers(machine: StandIn, navigator: Navigator) -> list[ActionHandler]:
    """The three actions of the navigation."""

    def handler(
        field: str, action: Any, poses: Callable[[Any], Sequence[PoseStamped]], through: bool = False
    ) -> ActionHandler:
        def begin(request: Any) -> Trip:
            waypoints = field == "follow_waypoints"
            miss = machine.fault.miss if waypoints else ()
            return navigator.begin(_legs(poses(request), through), waypoints=waypoints, miss=miss)

        def refusal(request: Any) -> str | None:
            return _strange_frame(poses(request)) or navigator.refusal(_legs(poses(request), through))

        return ActionHandler(
            field, action, refusal, begin, navigator.cancel, lambda trip: _feedback(action, navigator, trip),
            lambda trip, verdict: _result(action, trip, verdict),
        )  # fmt: skip

    return [
        handler("navigate_to_pose", NavigateToPose, lambda request: [request.pose]),
        handler("navigate_through_poses", NavigateThroughPoses, lambda request: request.poses, through=True),
        handler("follow_waypoints", FollowWaypoints, lambda request: request.poses),
    ]


def _strange_frame(poses: Sequence[PoseStamped]) -> str | None:
    frames = {pose.header.frame_id for pose in poses} - {MAP, ""}
    return f"poses in frame '{frames.pop()}': only '{MAP}' is known" if frames else None


def _legs(poses: Sequence[PoseStamped], through: bool) -> list[Leg]:
    """The legs for poses; a pose that is only passed has no yaw, except the last."""
    last = len(poses) - 1
    return [_leg(stamped.pose, not through or i == last) for i, stamped in enumerate(poses)]


def _leg(pose: Pose, stands: bool) -> Leg:
    q = pose.orientation
    return Leg(pose.position.x, pose.position.y, yaw_of((q.x, q.y, q.z, q.w)) if stands else None)


def _feedback(action: Any, navigator: Navigator, trip: Trip) -> Any:
    if action is FollowWaypoints:
        return FollowWaypoints.Feedback(current_waypoint=navigator.current(trip))
    base, away = navigator.base, navigator.base.left()
    now = PoseStamped()
    now.header.frame_id = MAP
    now.pose.position.x, now.pose.position.y = base.x, base.y
    _, _, now.pose.orientation.z, now.pose.orientation.w = about("z", base.yaw)
    reported = action.Feedback(
        current_pose=now, navigation_time=duration(trip.seconds), distance_remaining=away,
        estimated_time_remaining=duration(away / base.drive.velocity),
    )  # fmt: skip
    if action is NavigateThroughPoses:
        reported.number_of_poses_remaining = len(base.legs)
    return reported


def _result(action: Any, trip: Trip, verdict: MotionVerdict) -> Any:
    reported = action.Result()
    if hasattr(reported, "error_code"):  # Humble's results have no reason
        reported.error_code, reported.error_msg = verdict.code, verdict.text
    if action is FollowWaypoints and trip.missed:
        reported.missed_waypoints = missed_waypoints(trip.missed)
    return reported
