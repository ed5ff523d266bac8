"""Excavators: goals for the bucket become joint targets, each inside the joint limits."""

import math
from collections.abc import Iterable, Mapping

from tms_config.models import MachineModel
from tms_machine import geometry
from tms_machine.reasons import NoSuchJoint
from tms_reason.errors import ConfigError, SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.kind import Angles, Moves
from tms_rp.kinds.backhoe.goals import ChangePose, LinkGoal, TipGoal, finite
from tms_rp.kinds.backhoe.linkage import ArmAngles, Linkage, Tip, Vector, wrap
from tms_rp.reasons import (
    ClearanceCut,
    JointBroken,
    NoAngleDigs,
    NoArm,
    NoOrientation,
    OneTarget,
    OtherAngle,
    OutOfPlane,
    OutOfRange,
    Point,
    PointOutOfRange,
)

NAMES = ("swing_joint", "boom_joint", "arm_joint", "bucket_joint")
TOOL = "bucket_end_joint"  # a frame, not a joint: no command moves it

DEPTH = 1.0  # m, from a record's z (the ground) down to where the bucket digs
SEARCH_STEP = 0.01  # rad, of theta_w
CURLED = 1.7  # rad, bucket joint that holds the soil
CLEAR_ARM = 0.1  # rad, arm curls in by this much when the bucket closes or opens
CLEAR_BOOM = -0.15  # rad, boom rises by this much when the bucket opens
EMPTY = 1e-3  # a shorter quaternion counts as not filled in; others are brought to the length 1, as MoveIt does


class Backhoe:
    """Plans for one excavator model. Methods take the present joints and raise SubtaskFailed with a reason.

    The goal makes no sense, the arm is too short or too long for the point, or a joint would leave its limits.
    """

    def __init__(self, model: MachineModel) -> None:
        missing = [name for name in (*NAMES, TOOL) if name not in model.joints or name not in model.geometry]
        if "base_joint" not in model.geometry:  # it is fixed, so `joints:` does not have it
            missing.append("base_joint")
        if missing:
            raise ConfigError(NoArm(tuple(missing)))
        self.limits = {name: model.joints[name] for name in NAMES}
        self.linkage = Linkage.of(model.geometry)

    def change_pose(self, now: ArmAngles, goal: ChangePose) -> Moves:
        """Go through joint targets, link poses or bucket tips, whichever the goal gives."""
        given = [part for part in (goal.joints, goal.links, goal.tips) if part]
        if len(given) != 1:
            raise SubtaskFailed(OneTarget(len(given)))
        targets: list[ArmAngles] = []
        for values in goal.joints:
            targets.append(self._joints(now, targets, values))
        for tip in (*(self._link_tip(link, goal.aside) for link in goal.links), *(_tip(tip) for tip in goal.tips)):
            targets.append(_short_way(targets[-1] if targets else now, self.reach(tip)))
        return Moves(tuple(targets))

    def excavate(self, now: ArmAngles, goal: TipGoal) -> Moves:
        """Swing over the point, reach it with the nearest possible bucket angle, then curl the bucket in.

        The bucket digs DEPTH below the goal's z, `offset` further out on the line from the machine's origin.
        """
        theta_w = wrap(_tip(goal).theta_w - math.pi / 2) + math.pi / 2  # the turn that holds 0 to pi
        bearing = math.atan2(goal.y, goal.x)
        dig = Tip(
            goal.x + goal.offset * math.cos(bearing), goal.y + goal.offset * math.sin(bearing),
            goal.z - DEPTH, theta_w,
        )  # fmt: skip
        found, chosen = self._search(dig)
        reach = _short_way(now, found)
        notes: list[Reason] = [] if chosen == theta_w else [OtherAngle(chosen, theta_w)]
        arm = self._clip("arm_joint", reach.arm + CLEAR_ARM, notes)
        curl = self._allowed(reach, reach._replace(arm=arm, bucket=CURLED))
        return Moves((now._replace(swing=reach.swing), reach, curl), tuple(notes))

    def release(self, now: ArmAngles, angle: float) -> Moves:
        """Open the bucket to `angle` [rad] in two moves; the second also brings arm and boom up for clearance."""
        finite("target_angle", angle)
        notes: list[Reason] = []
        arm = self._clip("arm_joint", now.arm + CLEAR_ARM, notes)
        boom = self._clip("boom_joint", now.boom + CLEAR_BOOM, notes)
        end = self._allowed(now, ArmAngles(now.swing, boom, arm, angle))
        return Moves((now._replace(bucket=(now.bucket + angle) / 2), end), tuple(notes))

    def reach(self, tip: Tip) -> ArmAngles:
        """Joints inside their limits that bring the bucket tip there; swing in (-pi, pi]."""
        pose = self.linkage.joints(tip)
        bucket = self.limits["bucket_joint"]
        for turn in (math.tau, -math.tau):  # theta_w is an angle: full turns more or less are the same bucket
            if bucket.violation(pose.bucket) and not bucket.violation(pose.bucket + turn):
                pose = pose._replace(bucket=pose.bucket + turn)
        broken = self._broken(zip(NAMES, pose, strict=True))
        if broken:
            raise SubtaskFailed(PointOutOfRange(Point(*tip), broken))
        return pose

    def tool(self, now: Angles) -> tuple[Vector, geometry.Quaternion]:
        """Pose of bucket_end_link in base_link: position [m] and orientation."""
        pose = ArmAngles(*now)
        tip = self.linkage.tip(pose)
        turn = geometry.product(geometry.about("z", pose.swing), geometry.about("y", tip.theta_w + self.linkage.level))
        return (tip.x, tip.y, tip.z), turn

    def _search(self, tip: Tip) -> tuple[ArmAngles, float]:
        """Joints for the point with the possible theta_w nearest to the asked one, and that theta_w [rad]."""
        refused: list[SubtaskFailed] = []
        for theta_w in _outward(tip.theta_w):
            try:
                return self.reach(tip._replace(theta_w=theta_w)), theta_w
            except SubtaskFailed as error:
                refused.append(error)
        raise SubtaskFailed(NoAngleDigs(refused[0].reason))

    def _joints(self, now: ArmAngles, before: list[ArmAngles], values: Mapping[str, float]) -> ArmAngles:
        unknown = [name for name in values if name not in (*NAMES, TOOL)]
        if unknown:
            raise SubtaskFailed(NoSuchJoint(unknown[0], NAMES))
        finite("trajectory", *values.values())
        kept = {name: angle for name, angle in values.items() if name in NAMES and abs(angle) <= math.tau}
        target = ArmAngles(*(kept.get(name, angle) for name, angle in zip(NAMES, now, strict=True)))
        return self._allowed(now, _short_way(before[-1] if before else now, target))

    def _link_tip(self, link: LinkGoal, most: float) -> Tip:
        """The tip that a pose of bucket_end_link asks for; theta_w is its pitch in the plane of the arm."""
        finite("pose_sequence", *vars(link).values())
        turn = link.qx, link.qy, link.qz, link.qw
        if geometry.length(turn) < EMPTY:
            raise SubtaskFailed(NoOrientation(geometry.length(turn)))
        x, y, z = geometry.x_axis(geometry.unit(turn))
        swing = self.linkage.swing_to(link.x, link.y)
        out, aside = x * math.cos(swing) + y * math.sin(swing), y * math.cos(swing) - x * math.sin(swing)
        if abs(angle := math.asin(max(-1.0, min(1.0, aside)))) > most:
            raise SubtaskFailed(OutOfPlane(angle, swing))
        return Tip(link.x, link.y, link.z, wrap(math.atan2(-z, out) - self.linkage.level))

    def _allowed(self, now: ArmAngles, target: ArmAngles) -> ArmAngles:
        """The target, if every joint that it moves stays inside its limits."""
        moved = ((n, b) for n, a, b in zip(NAMES, now, target, strict=True) if a != b)
        broken = self._broken(moved)
        if broken:
            raise SubtaskFailed(OutOfRange(broken))
        return target

    def _broken(self, angles: Iterable[tuple[str, float]]) -> tuple[Reason, ...]:
        found = ((name, self.limits[name].violation(angle)) for name, angle in angles)
        return tuple(JointBroken(name, broken) for name, broken in found if broken)

    def _clip(self, name: str, angle: float, notes: list[Reason]) -> float:
        """The angle [rad] of a clearance move, cut at the joint's limit."""
        joint = self.limits[name]
        low, high = (-math.inf if joint.min is None else joint.min), (math.inf if joint.max is None else joint.max)
        cut = max(low, min(high, angle))
        if cut != angle:
            notes.append(ClearanceCut(name, cut))
        return cut


def _tip(goal: TipGoal) -> Tip:
    finite("position_with_angle", goal.x, goal.y, goal.z, goal.theta_w, goal.offset)
    return Tip(goal.x, goal.y, goal.z, goal.theta_w)


def _short_way(before: ArmAngles, target: ArmAngles) -> ArmAngles:
    """The target with its swing on the turn nearest to the present angle of the upper body."""
    return target._replace(swing=before.swing + wrap(target.swing - before.swing))


def _outward(theta_w: float) -> Iterable[float]:
    """Angles [rad] in the order in which they are tried: away from `theta_w`, up first, inside 0 to pi."""
    for step in range(math.ceil(math.pi / SEARCH_STEP)):
        away = step * SEARCH_STEP
        if theta_w + away <= math.pi:
            yield theta_w + away
        if away > 0 and theta_w - away >= 0:
            yield theta_w - away
