"""How much loose soil a bucket keeps at each tilt: up to the slope of repose, from both lips and both sides.

The bucket is its inner section over its width. In each vertical slice along the section a column of soil stands on the
bucket's floor and reaches up to the lowest of these slopes; above the opening it is the heap. Where only the opening is
below it, as in a bucket that is upside down, there is none.
"""

import math

import numpy as np

from tms_config.models import Bucket
from tms_soil.surface import Array

TILTS = np.radians(np.arange(-180.0, 180.0, 3.0))  # rad, pitch of the bucket's link
COLUMNS, SLICES = 48, 8  # along the section, and from a side to the middle


class Capacity:
    """Volumes [m3] of one bucket with soil of one slope of repose."""

    def __init__(self, bucket: Bucket, repose_slope: float) -> None:
        """`repose_slope`: rise by run."""
        self._volumes: Array = np.array([_volume(bucket, repose_slope, tilt) for tilt in TILTS])
        self.heaped = float(self._volumes.max())  # m3, at the best tilt

    def at(self, tilt: float) -> float:
        """What stays in at a pitch of the bucket's link [rad]."""
        return float(np.interp(math.remainder(tilt, math.tau), TILTS, self._volumes, period=math.tau))


def tilt_of(turn: Array) -> float:
    """Pitch [rad] of a link from its rotation matrix in map; to the side it is taken as level."""
    return math.atan2(-turn[2, 0], turn[2, 2])


def _volume(bucket: Bucket, slope: float, tilt: float) -> float:
    x, z = np.array(bucket.section).T
    x, z = x * math.cos(tilt) + z * math.sin(tilt), z * math.cos(tilt) - x * math.sin(tilt)
    step = (x.max() - x.min()) / COLUMNS
    at: Array = x.min() + step * (np.arange(COLUMNS) + 0.5)
    floor, ceiling, open_below, open_above = _columns(x, z, at)
    top = np.minimum(z[0] + slope * np.abs(at - x[0]), z[-1] + slope * np.abs(at - x[-1]))
    side = bucket.width / 2 * (np.arange(SLICES)[:, None] + 0.5) / SLICES
    rims = z[0] + (z[-1] - z[0]) * (at - x[0]) / (x[-1] - x[0] or math.inf)  # of the sides, along the opening
    surface = np.minimum(top, np.where(open_above, rims + slope * side, ceiling))
    depth = np.where(open_below, 0.0, np.maximum(surface - floor, 0.0))
    return float(depth.sum() * step * bucket.width / SLICES)


def _columns(x: Array, z: Array, at: Array) -> tuple[Array, Array, Array, Array]:
    """Floor and ceiling [m] of the section at places along it, and whether these are its opening."""
    ends = np.roll(np.arange(len(x)), -1)  # the last side, from the cutting edge to the rear lip, is the opening
    span = x[ends] - x
    share = (at - x[:, None]) / np.where(span == 0, np.inf, span)[:, None]
    cross = z[:, None] + share * (z[ends] - z)[:, None]
    crossed = (x[:, None] <= at) != (x[ends][:, None] <= at)
    low, high = np.where(crossed, cross, np.inf), np.where(crossed, cross, -np.inf)
    last = len(x) - 1
    return low.min(axis=0), high.max(axis=0), low.argmin(axis=0) == last, high.argmax(axis=0) == last
