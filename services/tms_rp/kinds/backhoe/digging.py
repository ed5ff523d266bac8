"""Digging and emptying the bucket, each as one motion through poses in the plane of the arm."""

import math
from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise

from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.clearance import PADDING
from tms_rp.kind import Moves, Through
from tms_rp.kinds.backhoe.bucket import LEVEL, TILT, tilt
from tms_rp.kinds.backhoe.goals import Dig, Emptying, finite
from tms_rp.kinds.backhoe.linkage import ArmAngles, Tip, wrap
from tms_rp.kinds.backhoe.planner import Backhoe, short_way, tip_of
from tms_rp.reasons import DigUnfit, DragCut, OtherAngle, Point, WouldSpill
from tms_rp.trench import Trench

OVER = 0.3  # m between the ground and the bucket before it goes down
SPEED = 0.6  # m/s of the tip through soil: our assumption
STEP = 0.25  # m between two poses of a drag
ROLL = 0.1  # rad by which the bucket may have to turn between them; more is no drag any more
BOOM_STEP = 0.02  # rad
SPARE = 0.1  # m between padded bodies and what they must not touch: the motion is rounded between the poses
CURLING = (0.0, 0.25, 0.5, 0.75, 1.0)  # shares of the curl at which the tracks are looked at
ASIDE = 0.2  # m that the bucket may be beside its plane while it is in the ground
ROUND = 0.3  # m that it may be beyond the poses of the dig there
CALM = 1.2  # s over the place before it opens: the upper body comes to rest meanwhile
CLEAR_ARM = 0.1  # rad, the arm curls in by this much when the bucket opens
CLEAR_BOOM = -0.15  # rad, the boom rises by this much when the bucket opens


def excavate(arm: Backhoe, now: ArmAngles, goal: Dig) -> Moves:
    """Over the place, down to its depth with the nearest possible bucket angle, towards the machine, curl, lift.

    The place is `offset` further out on the line from the machine's origin. The bucket ends level, above the ground.

    Raises:
        SubtaskFailed: DigUnfit, FieldNotFinite, NoAngleDigs.
    """
    at = tip_of(goal.at)
    finite("depth, drag, lift", goal.depth, goal.drag, goal.lift)
    if goal.depth <= 0 or goal.drag < 0 or goal.lift < 0:
        raise SubtaskFailed(DigUnfit(goal.depth, goal.drag, goal.lift))
    bearing = math.atan2(at.y, at.x)
    theta_w = wrap(at.theta_w - math.pi / 2) + math.pi / 2  # the turn that holds 0 to pi
    dig = Tip(
        at.x + goal.at.offset * math.cos(bearing), at.y + goal.at.offset * math.sin(bearing),
        at.z - goal.depth, theta_w,
    )  # fmt: skip
    fits = partial(_fits, arm, at.z)
    found, chosen = arm.search(dig, fits)
    notes: list[Reason] = [] if chosen == theta_w else [OtherAngle(chosen, theta_w)]
    reach, surface = short_way(now, found), max(0.0, at.z)
    dragged = _dragged(arm, reach, dig._replace(theta_w=chosen), goal.drag, fits, notes)
    over = raised(arm, reach, surface + OVER)
    curled = arm.level((reach, *dragged)[-1])
    lifted = raised(arm, curled, surface + goal.lift, level=True)
    tips = [arm.linkage.tip(pose)[:3] for pose in (over, reach, *dragged)]
    least = (0.0, *(math.dist(a, b) / SPEED for a, b in pairwise(tips)), 0.0, 0.0)
    targets = (over, reach, *dragged, curled, lifted)
    return Moves(targets, tuple(notes), through=Through(least, trench=_trench(arm, targets, at.z)))


def release(arm: Backhoe, now: ArmAngles, goal: Emptying) -> Moves:
    """Over the place with the bucket level, if there is one; then it opens, while arm and boom come up for clearance.

    Where an open bucket would hang into the ground, the boom rises first.

    Raises:
        SubtaskFailed: FieldNotFinite, NoAngleDigs, OutOfRange, WouldSpill.
    """
    finite("target_angle", goal.angle)
    notes: list[Reason] = []
    over = now if goal.over is None else _place(arm, now, tip_of(goal.over), notes)
    hanging = over._replace(bucket=arm.clip("bucket_joint", math.pi / 2 - over.boom - over.arm, []))
    risen = over._replace(boom=raised(arm, hanging, OVER).boom)
    curled = arm.clip("arm_joint", over.arm + CLEAR_ARM, notes)
    up = min(risen.boom, arm.clip("boom_joint", over.boom + CLEAR_BOOM, notes))
    end = arm.allowed(over, ArmAngles(over.swing, up, curled, goal.angle))
    if goal.over is not None:
        return Moves((over, over, end), tuple(notes), through=Through((0.0, CALM, 0.0), held=arm.held))
    targets = (end,) if risen == over else (risen, end)
    return Moves(targets, tuple(notes), through=Through((0.0,) * len(targets), free=False))


def raised(arm: Backhoe, pose: ArmAngles, height: float, level: bool = False) -> ArmAngles:
    """The pose with the boom so much higher that the bucket hangs at a height [m], or as high as it gets."""
    highest = arm.limits["boom_joint"].min
    assert highest is not None
    found = pose
    while arm.bucket.lowest(found) < height and found.boom > highest:
        found = found._replace(boom=max(highest, found.boom - BOOM_STEP))
        found = arm.level(found) if level else found
    return found


def _fits(arm: Backhoe, ground: float, pose: ArmAngles) -> bool:
    """Whether the arm is above the ground, and the bucket clear of the tracks, also when it curls from there."""
    gap = PADDING + SPARE
    if arm.arm.lowest(pose) < ground + gap:
        return False
    curl = arm.level(pose).bucket - pose.bucket
    curling = [pose._replace(bucket=pose.bucket + share * curl) for share in CURLING]
    return arm.tracks is None or not arm.bucket.near(curling, arm.tracks, gap)


def _dragged(
    arm: Backhoe, reach: ArmAngles, dig: Tip, drag: float, fits: Callable[[ArmAngles], bool], notes: list[Reason]
) -> Sequence[ArmAngles]:
    """Poses on the straight line towards the machine, as far as the arm gets with about the same bucket angle.

    A bucket that points outward turns on the way until it points down: curling from there goes no deeper.
    """
    found: list[ArmAngles] = []
    steps, theta_w = math.ceil(drag / STEP), dig.theta_w
    for number in range(1, steps + 1):
        way = drag * number / steps
        theta_w += min(ROLL, max(0.0, math.pi / 2 - theta_w))
        tip = Tip(dig.x - way * math.cos(reach.swing), dig.y - way * math.sin(reach.swing), dig.z, theta_w)
        try:
            pose, theta_w = arm.search(tip, fits, ROLL)
        except SubtaskFailed:
            break
        if not fits(pose):
            break
        found.append(short_way(reach, pose))
    if len(found) < steps:
        notes.append(DragCut(drag * len(found) / steps, drag))
    return found


def _place(arm: Backhoe, now: ArmAngles, at: Tip, notes: list[Reason]) -> ArmAngles:
    """The pose over a place, with the nearest possible bucket angle that holds soil."""
    wanted = wrap(at.theta_w - math.pi / 2) + math.pi / 2
    held = at._replace(theta_w=max(LEVEL - TILT, min(LEVEL, wanted)))
    found, chosen = arm.search(held, lambda pose: abs(tilt(pose)) <= TILT)
    if abs(tilt(found)) > TILT:
        raise SubtaskFailed(WouldSpill(Point(*held), abs(tilt(found))))
    if chosen != at.theta_w:
        notes.append(OtherAngle(chosen, at.theta_w))
    return short_way(now, found)


def _trench(arm: Backhoe, poses: Sequence[ArmAngles], top: float) -> Trench:
    """Where the bucket may be in the ground: in the plane of the arm, round the poses of the dig."""
    swing, (x, y, _) = poses[0].swing, arm.linkage.axis
    c, s = math.cos(swing), math.sin(swing)
    x, y = x - s * arm.linkage.lateral, y + c * arm.linkage.lateral
    corners = arm.bucket.corners(*poses)
    out = (corners[..., 0] - x) * c + (corners[..., 1] - y) * s
    width = 2 * (arm.bucket.half_width + PADDING + ASIDE)
    near, far = float(out.min()) - ROUND, float(out.max()) + ROUND
    return Trench(x, y, swing, width, near, far, top, arm.bucket.link)
