"""What is left to dig around an excavator, by the ground as it is now."""

from collections.abc import Sequence

import numpy as np

from tms_kit.machine import Machine
from tms_kit.reasons import NoPart
from tms_reason.errors import SubtaskFailed
from tms_soil.dig_point import Digging, DigPoint, Stand, dig_points
from tms_soil.surface import Bounds
from tms_subtasks.records.earthwork import Earthwork

AROUND = 0.5  # m of ground beside the area: a bucket is as wide


def left_to_dig(
    machine: Machine, work: Earthwork, holds: float, swing: float, without: Sequence[DigPoint]
) -> list[DigPoint]:
    """Where it may dig, the best first; `holds`: its bucket [m3, loose], `swing`: where its load goes [rad, base_link].

    `without`: digs that have brought nothing; what is like one of them is left out.

    Raises:
        SubtaskFailed: NoPart, or who does not tell what must be known.
    """
    bucket, yard, check = machine.model.bucket, machine.yard, machine.check
    if bucket is None:
        raise SubtaskFailed(NoPart(machine.name, "bucket"))
    stand = standing(machine, work.floor)
    x0, y0, x1, y1 = work.bounds
    ground, design = yard.ground((x0 - AROUND, y0 - AROUND, x1 + AROUND, y1 + AROUND), work.floor, check)
    tool = Digging.of(bucket, holds, work.near, work.far, work.deepest)
    found = dig_points(ground, design, stand, tool, work.area, yard.taken(machine.name), swing)
    return [one for one in found if not any(one.like(other) for other in without)]


def standing(machine: Machine, floor: float) -> Stand:
    """Where a machine stands, on the ground below it.

    Raises:
        SubtaskFailed: as `left_to_dig`.
    """
    yard, check = machine.yard, machine.check
    at = yard.place(machine.name, check)
    below: Bounds = at.x - AROUND, at.y - AROUND, at.x + AROUND, at.y + AROUND
    ground, _ = yard.ground(below, floor, check)
    height = float(np.nanmedian(ground.z)) if np.isfinite(ground.z).any() else 0.0
    return Stand(at.x, at.y, height, at.yaw)
