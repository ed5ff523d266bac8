"""The force that soil puts up against a blade, by the fundamental earthmoving equation (Reece 1964, McKyes 1985)."""

import functools
import math
from typing import NamedTuple

import numpy as np

from tms_soil.soils import Soil
from tms_soil.surface import Array

GRAVITY = 9.81  # m/s2
LEAST_RAKE, MOST_RAKE = math.radians(20), math.radians(90)  # rad, between which the wedge of the equation is one


class Factors(NamedTuple):
    """Bearing factors of soil weight, cohesion and surcharge, at the failure plane that needs the least force."""

    weight: float
    cohesion: float
    surcharge: float
    plane: float  # rad, the failure plane's angle to the horizontal


def factors(soil: Soil, rake: float) -> Factors:
    """Bearing factors for a blade at `rake` [rad], from the direction of its motion up to its face."""
    return _factors(soil.friction, soil.steel, round(math.degrees(min(max(rake, LEAST_RAKE), MOST_RAKE))))


@functools.lru_cache(maxsize=4096)
def _factors(friction: float, steel: float, rake: int) -> Factors:
    phi, delta, alpha = math.radians(friction), math.radians(steel), math.radians(rake)
    beta = np.radians(np.arange(5.0, 85.0, 0.1))  # rad, failure planes among which the least is looked for
    below = np.cos(alpha + delta) + np.sin(alpha + delta) / np.tan(beta + phi)
    weight = np.where(below > 0, (1 / math.tan(alpha) + 1 / np.tan(beta)) / (2 * below), math.inf)
    least = int(weight.argmin())
    cohesion = (1 + 1 / (np.tan(beta[least]) * np.tan(beta[least] + phi))) / below[least]
    return Factors(float(weight[least]), float(cohesion), float(2 * weight[least]), float(beta[least]))


def force(soil: Soil, rake: float, width: float, depths: Array, surcharge: float = 0.0) -> float:
    """Force [N] against a blade.

    `width` [m]; `depths` [m] below the surface at places evenly along its edge; `surcharge` [Pa] on the soil before it.
    Adhesion and the force of acceleration are left out: slow motion, and soil that does not stick.
    """
    found = factors(soil, rake)
    by_width = (
        soil.bank * GRAVITY * found.weight * depths * depths
        + (soil.cohesion * found.cohesion + surcharge * found.surcharge) * depths
    )
    return width * float(by_width.mean())


def speed_share(resistance: float, limit: float) -> float:
    """Share of its free speed at which a tool moves against a resistance; 0 is a stall. Both [N]."""
    return max(0.0, 1.0 - resistance / limit)
