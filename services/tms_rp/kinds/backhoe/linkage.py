"""Kinematics of an excavator arm: boom, arm and bucket in one vertical plane, on a turntable.

All lengths are in m and all angles in rad. `theta_w` is the downward pitch of the line from bucket pin to tip:
0 horizontal and outward, pi/2 straight down, pi pointing back. The formulas are the closed form of the inverse
kinematics that OPERA's planner uses; only its elbow-up branch exists, the other one is out of every joint limit.
A numerical solver was dropped: it is slower, and it cannot say by how much a point is out of reach.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from tms_config.models import Origin
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.reasons import Point, TooFar, TooNear, TooNearAxis

Vector = tuple[float, float, float]


class ArmAngles(NamedTuple):
    """Joint angles of the arm [rad], in the order of the controller."""

    swing: float
    boom: float
    arm: float
    bucket: float


class Tip(NamedTuple):
    """Origin of bucket_end_link in base_link [m], and the bucket angle [rad]."""

    x: float
    y: float
    z: float
    theta_w: float


def wrap(angle: float) -> float:
    """The same direction in (-pi, pi]."""
    turned = math.remainder(angle, math.tau)
    return turned if turned > -math.pi else math.pi


@dataclass(frozen=True)
class Linkage:
    """Lengths and offsets of one arm, worked out once from the joint origins of its URDF."""

    axis: Vector  # m, origin of the swing joint in base_link
    boom_pin: tuple[float, float]  # m, from the swing axis outward and up
    lateral: float  # m, offset of the arm's plane from the swing axis, to the left
    lengths: Vector  # m, boom pin to arm pin to bucket pin to tip
    offsets: Vector  # rad, joint angle minus pitch of the line, for boom, arm and bucket
    level: float  # rad, downward pitch of bucket_end_link when theta_w is 0

    @classmethod
    def of(cls, geometry: Mapping[str, Origin]) -> "Linkage":
        """Build from the joint origins of a machine model (all five joints and the fixed base_joint)."""
        base, s = geometry["base_joint"].xyz, geometry["swing_joint"].xyz
        b, a, k, e = (geometry[name] for name in ("boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint"))
        o1 = -b.pitch + _slope(a)
        o2 = -b.pitch - a.pitch - o1 + _slope(k)
        o3 = -b.pitch - a.pitch - k.pitch - o1 - o2 + _slope(e)
        return cls(
            axis=(base[0] + s[0], base[1] + s[1], base[2] + s[2]),
            boom_pin=(b.xyz[0], b.xyz[2]),
            lateral=b.xyz[1] + a.xyz[1] + k.xyz[1],
            lengths=(_length(a), _length(k), _length(e)),
            offsets=(o1, o2, o3),
            level=_slope(e) + e.pitch,
        )

    def tip(self, pose: ArmAngles) -> Tip:
        """Forward kinematics: where the bucket tip is, in base_link."""
        g1 = pose.boom - self.offsets[0]
        g2 = g1 + pose.arm - self.offsets[1]
        theta_w = g2 + pose.bucket - self.offsets[2]
        l1, l2, l3 = self.lengths
        out = self.boom_pin[0] + l1 * math.cos(g1) + l2 * math.cos(g2) + l3 * math.cos(theta_w)
        up = self.boom_pin[1] - l1 * math.sin(g1) - l2 * math.sin(g2) - l3 * math.sin(theta_w)
        c, s = math.cos(pose.swing), math.sin(pose.swing)
        x, y, z = self.axis
        return Tip(x + c * out - s * self.lateral, y + s * out + c * self.lateral, z + up, theta_w)

    def swing_to(self, x: float, y: float) -> float:
        """Swing angle [rad], in (-pi, pi], that brings the arm's plane over a point of base_link [m].

        Raises:
            SubtaskFailed: TooNearAxis, the point is nearer to the swing axis than the arm's plane.
        """
        found = self._swing_to(x, y)
        if isinstance(found, Reason):
            raise SubtaskFailed(found)
        return found

    def _swing_to(self, x: float, y: float) -> float | Reason:
        px, py = x - self.axis[0], y - self.axis[1]
        out = _root(px * px + py * py - self.lateral**2)
        if out is None:
            return TooNearAxis(x, y, abs(self.lateral) - math.hypot(px, py))
        return wrap(math.atan2(py, px) - math.atan2(self.lateral, out))

    def joints(self, tip: Tip) -> ArmAngles | Reason:
        """Inverse kinematics, elbow up, without joint limits; `tip` is in base_link.

        Else TooFar, TooNear or TooNearAxis, with how much is missing: in a search, each error would cost ten times the
        geometry.
        """
        swing = self._swing_to(tip.x, tip.y)
        if isinstance(swing, Reason):
            return swing
        px, py = tip.x - self.axis[0], tip.y - self.axis[1]
        out = _root(px * px + py * py - self.lateral**2) or 0.0
        l1, l2, l3 = self.lengths
        wx = out - self.boom_pin[0] - l3 * math.cos(tip.theta_w)
        wz = tip.z - self.axis[2] - self.boom_pin[1] + l3 * math.sin(tip.theta_w)
        far = math.hypot(wx, wz)
        if not abs(l1 - l2) <= far <= l1 + l2:
            point = Point(*tip)
            return TooFar(point, far - l1 - l2) if far > l1 + l2 else TooNear(point, abs(l1 - l2) - far)
        g1 = -_corner(l1, far, l2) - math.atan2(wz, wx)
        g2 = math.pi - _corner(l1, l2, far)
        g3 = tip.theta_w - g1 - g2
        o1, o2, o3 = self.offsets
        return ArmAngles(swing, g1 + o1, g2 + o2, g3 + o3)


def _corner(p: float, q: float, opposite: float) -> float:
    """Angle [rad] between the sides p and q of a triangle; clamped, for rounding at full stretch."""
    cosine = (p * p + q * q - opposite * opposite) / (2 * p * q)
    return math.acos(max(-1.0, min(1.0, cosine)))


def _root(square: float) -> float | None:
    return math.sqrt(square) if square >= 0 else None


def _slope(origin: Origin) -> float:
    return math.atan2(origin.xyz[2], origin.xyz[0])


def _length(origin: Origin) -> float:
    return math.hypot(origin.xyz[0], origin.xyz[2])
