"""Plans of an arm on the same path, but as fast as the limits of the joints allow."""

from collections.abc import Iterator, Mapping
from itertools import pairwise

from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_config.models import Joint
from tms_machine.stamps import duration, seconds


def retimed(plan: JointTrajectory, joints: Mapping[str, Joint]) -> JointTrajectory:
    """The plan with all times multiplied by one factor, with which one joint reaches one of its limits.

    Velocities go with the factor, accelerations with its square, jerks with its cube. A plan without velocities stays.
    """
    factor = max(_factors(plan, joints), default=0.0)
    if factor <= 0:
        return plan
    points = [
        JointTrajectoryPoint(
            positions=point.positions,
            velocities=[speed / factor for speed in point.velocities],
            accelerations=[change / factor**2 for change in point.accelerations],
            time_from_start=duration(seconds(point.time_from_start) * factor),
        )
        for point in plan.points
    ]
    return JointTrajectory(joint_names=plan.joint_names, points=points)


def _factors(plan: JointTrajectory, joints: Mapping[str, Joint]) -> Iterator[float]:
    """For each limit and point, the factor with which the limit is reached there."""
    known = [(index, joints[name]) for index, name in enumerate(plan.joint_names) if name in joints]
    for before, after in pairwise(plan.points):
        passed = seconds(after.time_from_start) - seconds(before.time_from_start)
        for index, joint in known:
            if index < len(after.velocities):
                yield abs(after.velocities[index]) / joint.velocity
            if index < min(len(before.accelerations), len(after.accelerations)) and passed > 0:
                changed = abs(after.accelerations[index] - before.accelerations[index]) / passed
                yield (abs(after.accelerations[index]) / joint.acceleration) ** (1 / 2)
                yield (changed / joint.jerk) ** (1 / 3)
