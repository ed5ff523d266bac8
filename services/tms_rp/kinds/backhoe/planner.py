"""Excavators: goals for the bucket become joint targets, each inside the joint limits."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

from tms_config.models import MachineModel
from tms_machine import geometry
from tms_machine.reasons import NoSuchJoint
from tms_reason.errors import ConfigError, SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.kind import Angles, Moves, Through
from tms_rp.kinds.backhoe.bucket import EMPTIED, LEVEL, TILT, Body, tilt
from tms_rp.kinds.backhoe.goals import ChangePose, LinkGoal, TipGoal, finite
from tms_rp.kinds.backhoe.linkage import ArmAngles, Linkage, Tip, Vector, wrap
from tms_rp.reasons import (
    ClearanceCut,
    JointBroken,
    NoAngleDigs,
    NoArm,
    NoOrientation,
    OneTarget,
    OutOfPlane,
    OutOfRange,
    Point,
    PointOutOfRange,
)

NAMES = ("swing_joint", "boom_joint", "arm_joint", "bucket_joint")
TOOL = "bucket_end_joint"  # a frame, not a joint: no command moves it

SEARCH_STEP = 0.01  # rad, of theta_w
EMPTY = 1e-3  # a shorter quaternion counts as not filled in; others are brought to the length 1, as MoveIt does
SWINGS = 0.05  # rad of the upper body that spill nothing


class Backhoe:
    """Plans for one excavator model. Methods take the present joints and raise SubtaskFailed with a reason.

    The goal makes no sense, the arm is too short or too long for the point, or a joint would leave its limits.
    """

    def __init__(self, model: MachineModel) -> None:
        missing = [name for name in (*NAMES, TOOL) if name not in model.joints or name not in model.geometry]
        if "base_joint" not in model.geometry:  # it is fixed, so `joints:` does not have it
            missing.append("base_joint")
        links = [model.geometry[name].child for name in ("arm_joint", "bucket_joint") if name in model.geometry]
        missing += [link for link in links if link not in model.shapes]
        if missing:
            raise ConfigError(NoArm(tuple(missing)))
        self.limits = {name: model.joints[name] for name in NAMES}
        self.bucket, self.arm = Body(model, "bucket_joint"), Body(model, "arm_joint")
        self.tracks = model.shapes.get(model.geometry["swing_joint"].parent)
        self._loaded = False  # it has dug, and was not seen open since
        self.linkage = Linkage.of(model.geometry)

    def change_pose(self, now: ArmAngles, goal: ChangePose) -> Moves:
        """Go through joint targets, link poses or bucket tips, whichever the goal gives."""
        given = [part for part in (goal.joints, goal.links, goal.tips) if part]
        if len(given) != 1:
            raise SubtaskFailed(OneTarget(len(given)))
        targets: list[ArmAngles] = []
        for values in goal.joints:
            targets.append(self._joints(now, targets, values))
        for tip in (*(self._link_tip(link, goal.aside) for link in goal.links), *(tip_of(tip) for tip in goal.tips)):
            targets.append(short_way(targets[-1] if targets else now, self.reach(tip)))
        return Moves(tuple(targets))

    def begins(self, now: Angles, moves: Moves) -> None:
        """Take note of a motion that begins: one that digs loads the bucket, which was empty if it is open."""
        digs = moves.through is not None and moves.through.trench is not None
        self._loaded = digs or self._carries(ArmAngles(*now))

    def _carries(self, pose: ArmAngles) -> bool:
        return self._loaded and tilt(pose) < EMPTIED

    def carrying(self, now: ArmAngles, moves: Moves) -> Moves:
        """The same with the bucket level while it swings, if it carries soil; it opens where the motion ends."""
        target = ArmAngles(*moves.targets[-1])
        if not self._carries(now) or len(moves.targets) > 1 or abs(target.swing - now.swing) < SWINGS:
            return moves
        targets = (target,) if abs(tilt(target)) <= TILT else (self.level(target), target)
        return replace(moves, targets=targets, through=Through((0.0,) * len(targets), held=self.held))

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

    def level(self, pose: ArmAngles) -> ArmAngles:
        """The pose with the bucket level, or as near to it as the bucket gets."""
        return pose._replace(bucket=self.clip("bucket_joint", LEVEL - pose.boom - pose.arm, []))

    def held(self, pose: Angles) -> Angles | None:
        """A pose on a way, with the bucket level; None where it cannot hold its soil."""
        level = self.level(ArmAngles(*pose))
        return level if abs(tilt(level)) <= TILT else None

    def search(self, tip: Tip, fits: Callable[[ArmAngles], bool], most: float = math.pi) -> tuple[ArmAngles, float]:
        """Joints for the point with the possible theta_w nearest to the asked one, and that theta_w [rad].

        It is at most `most` [rad] from the asked one, and one that fits if there is one; else the collision check will
        tell what it touches.
        """
        possible: list[tuple[ArmAngles, float]] = []
        refused: list[SubtaskFailed] = []
        for theta_w in _outward(tip.theta_w, most):
            try:
                possible.append((self.reach(tip._replace(theta_w=theta_w)), theta_w))
            except SubtaskFailed as error:
                refused.append(error)
                continue
            if fits(possible[-1][0]):
                return possible[-1]
        if possible:
            return possible[0]
        raise SubtaskFailed(NoAngleDigs(refused[0].reason))

    def _joints(self, now: ArmAngles, before: list[ArmAngles], values: Mapping[str, float]) -> ArmAngles:
        unknown = [name for name in values if name not in (*NAMES, TOOL)]
        if unknown:
            raise SubtaskFailed(NoSuchJoint(unknown[0], NAMES))
        finite("trajectory", *values.values())
        kept = {name: angle for name, angle in values.items() if name in NAMES and abs(angle) <= math.tau}
        target = ArmAngles(*(kept.get(name, angle) for name, angle in zip(NAMES, now, strict=True)))
        return self.allowed(now, short_way(before[-1] if before else now, target))

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

    def allowed(self, now: ArmAngles, target: ArmAngles) -> ArmAngles:
        """The target, if every joint that it moves stays inside its limits."""
        moved = ((n, b) for n, a, b in zip(NAMES, now, target, strict=True) if a != b)
        broken = self._broken(moved)
        if broken:
            raise SubtaskFailed(OutOfRange(broken))
        return target

    def _broken(self, angles: Iterable[tuple[str, float]]) -> tuple[Reason, ...]:
        found = ((name, self.limits[name].violation(angle)) for name, angle in angles)
        return tuple(JointBroken(name, broken) for name, broken in found if broken)

    def clip(self, name: str, angle: float, notes: list[Reason]) -> float:
        """The angle [rad] of a clearance move, cut at the joint's limit."""
        joint = self.limits[name]
        low, high = (-math.inf if joint.min is None else joint.min), (math.inf if joint.max is None else joint.max)
        cut = max(low, min(high, angle))
        if cut != angle:
            notes.append(ClearanceCut(name, cut))
        return cut


def tip_of(goal: TipGoal) -> Tip:
    """The tip of a goal, without its offset."""
    finite("position_with_angle", goal.x, goal.y, goal.z, goal.theta_w, goal.offset)
    return Tip(goal.x, goal.y, goal.z, goal.theta_w)


def short_way(before: ArmAngles, target: ArmAngles) -> ArmAngles:
    """The target with its swing on the turn nearest to the present angle of the upper body."""
    return target._replace(swing=before.swing + wrap(target.swing - before.swing))


def _outward(theta_w: float, most: float) -> Iterable[float]:
    """Angles [rad] in the order in which they are tried: away from `theta_w`, up first, inside 0 to pi."""
    for step in range(math.ceil(most / SEARCH_STEP)):
        away = step * SEARCH_STEP
        if theta_w + away <= math.pi:
            yield theta_w + away
        if away > 0 and theta_w - away >= 0:
            yield theta_w - away
