"""Where an excavator opens its bucket over a vessel, so that one bucket after another fills it evenly."""

import math
from dataclasses import dataclass

import numpy as np

from tms_config.models import Vessel
from tms_control.links import Matrix
from tms_soil.dig_point import Stand

FULL = 0.9  # of its heaped volume: another bucket would run over
FALLS = 1.0  # m further out than the tip of a level bucket, on average: there its soil comes down when it opens
ABOVE = 1.6  # m from the highest edge to the tip of a level bucket, which hangs below it when it is open


@dataclass(frozen=True)
class DumpPoint:
    """Where the tip of a level bucket is before it opens, in base_link of the excavator."""

    x: float  # m
    y: float  # m
    z: float  # m


def full(vessel: Vessel, load: float) -> bool:
    """Whether a vessel with a load [m3, loose] is to be hauled."""
    return load >= FULL * vessel.heaped


def dump_point(
    vessel: Vessel, place: Matrix, edge: float, load: float, width: float, bucket: float, stand: Stand
) -> DumpPoint:
    """Over that part of the vessel whose turn it is.

    Its length has as many parts as buckets fit side by side; each gets one before the first gets another. Which one
    follows from the load, so whoever begins anew needs no memory.

    Args:
        vessel: that of the carrier.
        place: of the vessel's link in map.
        edge: highest point of its sides [m, in its link].
        load: that it has [m3, loose].
        width: of the bucket [m].
        bucket: what it brings [m3, loose].
        stand: the excavator.
    """
    least, most = np.array(vessel.min), np.array(vessel.max)
    parts = max(1, int((most[0] - least[0]) / width))
    turn = int(load / bucket + 0.5) % parts
    along = most[0] - (most[0] - least[0]) * (turn + 0.5) / parts  # the cab is at its front: that is filled first
    middle = place @ np.array([along, (least[1] + most[1]) / 2, edge, 1.0])
    dx, dy = float(middle[0]) - stand.x, float(middle[1]) - stand.y
    out, bearing = math.hypot(dx, dy), math.atan2(dy, dx) - stand.yaw
    tip = out - FALLS
    return DumpPoint(tip * math.cos(bearing), tip * math.sin(bearing), float(middle[2]) - stand.z + ABOVE)
