"""Orientations as quaternions (x, y, z, w), the one place for their formulas."""

import math

Quaternion = tuple[float, float, float, float]  # x, y, z, w

QUATERNION_TOLERANCE = 0.02  # of a length from 1: people type records with two or three decimals


def length(turn: Quaternion) -> float:
    """The length of a quaternion: 1 for an orientation."""
    return math.hypot(*turn)


def is_orientation(turn: Quaternion) -> bool:
    """Whether a quaternion is meant as an orientation: its length is 1 within QUATERNION_TOLERANCE."""
    return abs(length(turn) - 1.0) <= QUATERNION_TOLERANCE


def unit(turn: Quaternion) -> Quaternion:
    """The same orientation with the length 1; the length must not be 0."""
    by = length(turn)
    x, y, z, w = turn
    return x / by, y / by, z / by, w / by


def about(axis: str, angle: float) -> Quaternion:
    """The turn by an angle [rad] about one axis."""
    s, c = math.sin(angle / 2), math.cos(angle / 2)
    return (s * (axis == "x"), s * (axis == "y"), s * (axis == "z"), c)


def yaw_of(turn: Quaternion) -> float:
    """The heading [rad] in [-pi, pi], whatever the length; 0 for the length 0."""
    x, y, z, w = turn
    return math.atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z)


def x_axis(turn: Quaternion) -> tuple[float, float, float]:
    """Direction of the x axis after the turn, whose length must be 1."""
    x, y, z, w = turn
    return 1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)


def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """First `b`, then `a` (Hamilton's product)."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )
