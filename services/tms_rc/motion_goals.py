"""What the gateway reads from goals of different types, and writes into their results."""

from collections.abc import Sequence
from typing import Any

from geometry_msgs.msg import Pose, PoseStamped
from trajectory_msgs.msg import JointTrajectoryPoint

from tms_machine.border import MotionAction
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
