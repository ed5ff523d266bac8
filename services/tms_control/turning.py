"""The trajectory that brings one joint to an angle as soon as its limits allow, the others staying. Pure logic."""

from collections.abc import Mapping

from ruckig import InputParameter, Result, Ruckig, Trajectory

from tms_config.models import Joint
from tms_control.reference_trajectory import Knot

EVERY = 0.1  # s between points
NEAR = 1e-6  # rad: no way at all


def turning(joints: Mapping[str, Joint], now: Mapping[str, float], name: str, angle: float) -> list[Knot]:
    """Points in the order of `joints`, from angles `now` [rad], at rest at both ends.

    Raises:
        ValueError: ruckig finds no trajectory; that would be a defect, as any two angles have one.
    """
    limits, begin = joints[name], now[name]
    if abs(angle - begin) < NEAR:
        return [Knot(EVERY, tuple(now[one] for one in joints), tuple(0.0 for _ in joints))]
    asked, found = InputParameter(1), Trajectory(1)
    asked.current_position, asked.target_position = [begin], [angle]
    asked.max_velocity, asked.max_acceleration = [limits.velocity], [limits.acceleration]
    asked.max_jerk = [limits.jerk]
    if Ruckig(1).calculate(asked, found) != Result.Working:
        raise ValueError(f"no trajectory for {name} from {begin} to {angle}")
    count = max(1, round(found.duration / EVERY))
    return [_knot(joints, now, name, found, found.duration * (i + 1) / count) for i in range(count)]


def _knot(joints: Mapping[str, Joint], now: Mapping[str, float], name: str, found: Trajectory, time: float) -> Knot:
    (position,), (velocity,), _ = found.at_time(time)
    positions = tuple(position if one == name else now[one] for one in joints)
    return Knot(time, positions, tuple(velocity if one == name else 0.0 for one in joints))
