"""Parts of motion messages that their servers read or fill in, with the types of Jazzy or of Humble, as built."""

from collections.abc import Sequence
from typing import Any

from nav2_msgs.action import FollowWaypoints
from trajectory_msgs.msg import JointTrajectory

from tms_control.reference_trajectory import Knot
from tms_machine import stamps

MISSED = 601  # error code of a waypoint that was not reached


def knots(trajectory: JointTrajectory) -> list[Knot]:
    """The points of a trajectory."""
    return [Knot(stamps.seconds(p.time_from_start), tuple(p.positions), tuple(p.velocities)) for p in trajectory.points]


def missed_waypoints(numbers: Sequence[int]) -> Any:
    """The waypoints, from 0, that FollowWaypoints has missed."""
    if not hasattr(FollowWaypoints.Result(), "error_code"):
        return list(numbers)
    from nav2_msgs.msg import MissedWaypoint  # Humble has no such message

    return [MissedWaypoint(index=number, error_code=MISSED) for number in numbers]
