"""The poses in goals of the navigation, in the frame `map`."""

import math
from collections.abc import Sequence
from typing import Any

from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path

from tms_control.path import Path as Way
from tms_control.path import Pose
from tms_machine.frames import MAP
from tms_machine.geometry import about, is_orientation, yaw_of
from tms_machine.places import IN_MAP
from tms_mc.reasons import NoPoses, PoseUnfit, StrangeFrame
from tms_reason.reason import Reason


def poses_of(request: Any) -> Sequence[PoseStamped]:
    """The poses that a goal asks to be driven to, or along."""
    if hasattr(request, "path"):
        return list(request.path.poses)
    return list(request.poses) if hasattr(request, "poses") else [request.pose]


def refuse(request: Any) -> Reason | None:
    """Why a goal to drive is refused."""
    path = getattr(request, "path", None)
    return wrong(poses_of(request), "" if path is None else path.header.frame_id)


def wrong(poses: Sequence[PoseStamped], frame: str = "") -> Reason | None:
    """What is wrong with poses; `frame` is that of poses that name none."""
    if not poses:
        return NoPoses()
    for number, stamped in enumerate(poses):
        at, q = stamped.pose.position, stamped.pose.orientation
        told = stamped.header.frame_id or frame
        if told not in (*IN_MAP, ""):
            return StrangeFrame(number, told)
        if not (math.isfinite(at.x) and math.isfinite(at.y) and is_orientation((q.x, q.y, q.z, q.w))):
            return PoseUnfit(number)
    return None


def pose_of(stamped: PoseStamped) -> Pose:
    """A pose of a message."""
    at, q = stamped.pose.position, stamped.pose.orientation
    return Pose(at.x, at.y, yaw_of((q.x, q.y, q.z, q.w)))


def in_map_along(way: Way, step: float) -> Path:
    """The poses of a path, at most `step` [m] apart, for a message."""
    told = Path(poses=[in_map(pose) for pose in way.poses(step)])
    told.header.frame_id = MAP
    return told


def in_map(pose: Pose) -> PoseStamped:
    """A pose for a message."""
    stamped = PoseStamped()
    stamped.header.frame_id = MAP
    stamped.pose.position.x, stamped.pose.position.y = pose.x, pose.y
    _, _, stamped.pose.orientation.z, stamped.pose.orientation.w = about("z", pose.yaw)
    return stamped
