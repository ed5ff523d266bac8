"""Out of what an arm seems to be in at its start: along the direction in which the overlap gets less fastest."""

from collections.abc import Callable, Sequence

import numpy as np

from tms_control.links import Array
from tms_rp.kind import Angles

STEP = 0.03  # rad of the fastest joint a step: a tip at 9 m moves 0.3 m
STEPS = 40
PROBE = 0.002  # rad to each side, to see in which direction the overlap gets less
FLAT = 1e-3  # m/rad: less says no direction

Bounds = Sequence[tuple[float, float]]  # rad, by joint


def way_out(depths: Callable[[Array], Array], pose: Angles, bounds: Bounds) -> Angles | None:
    """The pose in which nothing overlaps any more; None where the overlap does not get less all the way.

    `depths`: how deep all overlaps are [m, the sum] at poses (N x joints).
    """
    here, low, high = np.array(pose), *np.array(bounds).T
    depth = float(depths(here[None])[0])
    for _ in range(STEPS):
        if depth <= 0:
            return tuple(map(float, here))
        probes = np.eye(len(here)) * PROBE
        found = depths(np.concatenate([here + probes, here - probes]))
        slope = (found[: len(here)] - found[len(here) :]) / (2 * PROBE)
        steepest = float(np.abs(slope).max())
        if steepest < FLAT:
            return None
        here = np.clip(here - slope / steepest * STEP, low, high)
        before, depth = depth, float(depths(here[None])[0])
        if depth >= before:
            return None
    return None
