"""How an operator goes around something: lift, swing, lower; or lift, curl in, swing, unfold. Either way round.

In a motion that does not stop, the boom rises and sinks while the upper body turns, as much as there is room.

The bucket opens on none of these ways further than at both ends, so that no soil falls out.
"""

import math
from collections.abc import Iterable, Sequence

from tms_config.models import MachineModel
from tms_rp.kind import Angles, Manners, Way
from tms_rp.kinds.backhoe.linkage import ArmAngles
from tms_rp.reasons import FoldSwingUnfold, LiftSwingLower, OtherWayRound

LIFT = 0.25  # rad, a small lift of the boom: about 2 m at the bucket
LIFT_STEP = 0.05  # rad
ARM_FOLDED = 0.85  # share of the arm's range, from stretched out to curled in
CURLED = 1.7  # rad, bucket joint that holds the soil
ASIDE = 0.5  # rad by which a search may swing further than to the ends
# Shares of a swing in which the boom rises, and sinks: as much as possible first.
OVERLAPS = ((0.5, 0.3), (0.25, 0.25), (0.1, 0.1))


def ways(model: MachineModel, now: Angles, target: Angles) -> Iterable[Way]:
    """Ways from a pose to a target [rad], the shortest first; some end whole turns of the upper body away from it."""
    begin, highest = ArmAngles(*now), _range(model, "boom_joint")[0]
    for number, end in enumerate(targets(model, now, target)):
        lifts = dict.fromkeys(max(highest, min(begin.boom, end.boom) - lift) for lift in (LIFT, math.inf))
        for boom in lifts:
            for way in (_lifted(begin, end, boom), _folded(model, begin, end, boom)):
                yield Way(way.targets, OtherWayRound(way.name)) if number and way.name else way


def flowing(model: MachineModel, now: Angles, target: Angles) -> Iterable[Way]:
    """The same for motions that do not stop; the straight way is none of them."""
    begin, end, highest = ArmAngles(*now), ArmAngles(*target), _range(model, "boom_joint")[0]
    high = min(begin.boom, end.boom)
    for boom in dict.fromkeys(max(highest, high - lift) for lift in (0.0, LIFT, math.inf)):
        for rising, sinking in OVERLAPS:
            yield _while_swinging(begin, end, boom, rising, sinking)
    yield from ways(model, now, target)


def targets(model: MachineModel, now: Angles, target: Angles) -> Sequence[ArmAngles]:
    """The target [rad], and the same with the upper body turned to it the other way round, where it turns for ever."""
    end, swing = ArmAngles(*target), model.joints["swing_joint"]
    if swing.min is not None or swing.max is not None:
        return [end]
    return [end, end._replace(swing=end.swing - math.copysign(math.tau, end.swing - now[0]))]


def lifts(model: MachineModel, pose: Angles) -> Iterable[ArmAngles]:
    """The pose, and others with the boom ever higher [rad]."""
    begin, highest = ArmAngles(*pose), _range(model, "boom_joint")[0]
    yield begin
    for step in range(1, math.ceil((begin.boom - highest) / LIFT_STEP) + 1):
        yield begin._replace(boom=max(highest, begin.boom - step * LIFT_STEP))


def bounds(model: MachineModel, ends: Sequence[Angles]) -> Sequence[tuple[float, float]]:
    """Least and most of each joint [rad] in a search between poses; one that sags past its limit may begin there."""
    swing, boom, arm, bucket = zip(*ends, strict=True)
    wide = [(min(swing) - ASIDE, max(swing) + ASIDE)]
    for name, angles in (("boom_joint", boom), ("arm_joint", arm)):
        low, high = _range(model, name)
        wide.append((min(low, *angles), max(high, *angles)))
    return [*wide, (min(bucket), max(_range(model, "bucket_joint")[1], *bucket))]


MANNERS = Manners(ways, flowing, lifts, targets, bounds)


def _lifted(begin: ArmAngles, end: ArmAngles, boom: float) -> Way:
    up = begin._replace(boom=boom)
    over = end._replace(boom=boom, arm=begin.arm, bucket=max(begin.bucket, end.bucket))
    return Way((up, over, end._replace(boom=boom), end), LiftSwingLower())


def _while_swinging(begin: ArmAngles, end: ArmAngles, boom: float, rising: float, sinking: float) -> Way:
    turn = end.swing - begin.swing
    up = begin._replace(swing=begin.swing + rising * turn, boom=boom)
    arm, bucket = max(begin.arm, end.arm), max(begin.bucket, end.bucket)
    over = ArmAngles(end.swing - sinking * turn, boom, arm, bucket)
    return Way((up, over, end), LiftSwingLower())


def _folded(model: MachineModel, begin: ArmAngles, end: ArmAngles, boom: float) -> Way:
    low, high = _range(model, "arm_joint")
    up = begin._replace(boom=boom)
    arm = max(begin.arm, end.arm, low + ARM_FOLDED * (high - low))
    curled = up._replace(arm=arm, bucket=max(begin.bucket, end.bucket, CURLED))
    over = curled._replace(swing=end.swing)
    return Way((up, curled, over, end._replace(boom=boom), end), FoldSwingUnfold())


def _range(model: MachineModel, name: str) -> tuple[float, float]:
    """The limits of a joint that does not turn for ever [rad]."""
    low, high = model.joints[name].min, model.joints[name].max
    assert low is not None and high is not None
    return low, high
