"""What the gateway reads from goals of different types, and writes into their results."""

from collections.abc import Sequence
from typing import Any

from geometry_msgs.msg import Pose, PoseStamped
from trajectory_msgs.msg import JointTrajectoryPoint

from tms_machine.border import MotionAction
from tms_machine.geometry import yaw_of
from tms_machine.places import IN_MAP
from tms_machine.stamps import seconds
from tms_rc.limits import TrajectoryPoint
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ros.goals import Ended, Outcome

REFUSED = -1  # control_msgs INVALID_GOAL
UNKNOWN = 600  # for nav2_msgs, whose results have an unsigned code


def poses_of(request: Any) -> Sequence[PoseStamped]:
    """The poses of a goal for the navigation."""
    if hasattr(request, "path"):
        return list(request.path.poses)
    return list(request.poses) if hasattr(request, "poses") else [request.pose]


def places_of(request: Any) -> list[tuple[float, float, float]] | None:
    """The places x, y [m], yaw [rad] of a goal for the navigation, checked by the limits; None for another goal."""
    if hasattr(request, "trajectory") or hasattr(request, "target_angle") or hasattr(request, "goal_position"):
        return None
    told = [numbers(one.pose) for one in poses_of(request)]
    return [(x, y, yaw_of((qx, qy, qz, qw))) for x, y, _, qx, qy, qz, qw in told]


def frame_of(request: Any) -> str:
    """A frame of a goal's poses that is not the map's; empty for none."""
    frames = {one.header.frame_id for one in poses_of(request)}
    return next(iter(sorted(frames - {*IN_MAP, ""})), "")


def way_of(request: Any, joint: str | None) -> list[dict[str, float]]:
    """The angles [rad] by which a goal leads joints; `joint`: the one that an angle of another goal turns."""
    if hasattr(request, "trajectory"):
        wanted = request.trajectory
        return [dict(zip(wanted.joint_names, point.positions, strict=True)) for point in wanted.points]
    if hasattr(request, "goal_position"):
        return [dict(zip(request.joint_name, request.goal_position, strict=True))]
    return [] if joint is None else [{joint: float(request.target_angle)}]


def numbers(pose: Pose) -> tuple[float, ...]:
    """Position [m] and quaternion."""
    at, turn = pose.position, pose.orientation
    return at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w


def point_of(point: JointTrajectoryPoint) -> TrajectoryPoint:
    """The part of a trajectory's point that the limits check."""
    rest = [*point.velocities, *point.accelerations, *point.effort]
    return TrajectoryPoint(seconds(point.time_from_start), point.positions, rest)


def duration(request: Any) -> float:
    """How long a goal says that it lasts [s]; a goal for the navigation does not say."""
    if not hasattr(request, "trajectory"):
        return float("inf")
    return seconds(request.trajectory.points[-1].time_from_start)


def reason_of(result: Any) -> str:
    """The text in a result, where its type has one."""
    return str(getattr(result, "error_string", "") or getattr(result, "error_msg", ""))


def with_reason(motion: MotionAction, reason: Reason, code: int | None = None) -> Any:
    """A result of the motion's type, with as much of the reason as the type has room for."""
    result, line = motion.type.Result(), to_line(reason)
    if hasattr(result, "error_string"):
        result.error_code, result.error_string = REFUSED if code is None else code, line
    elif hasattr(result, "error_msg"):
        result.error_code, result.error_msg = UNKNOWN if code is None else code, line
    return result


def aborted(motion: MotionAction, reason: Reason) -> Ended[Any]:
    """The end of a goal that must not go on."""
    return Outcome.ABORTED, with_reason(motion, reason)
