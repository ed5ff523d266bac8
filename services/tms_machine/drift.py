"""How far a machine may have moved since it told where it was.

A machine that is not heard any more loses its permits and stops, so that this has an end.
"""

import numpy as np

from tms_config.models import DRIVE, MachineModel
from tms_decision.permit_link import LEASE

FRESH = 1.0  # s, what was told longer ago may be wrong


def drift(model: MachineModel, age: float) -> float:
    """How far [m] a point of a machine may have come by driving and turning since it told its place `age` [s] ago."""
    drive = model.drive
    if drive is None:
        return 0.0
    sizes = [np.hypot(*np.abs([box.min, box.max]).max(axis=0)[:2]) for box in model.footprint.values()]
    speed = drive.velocity + drive.turn_velocity * max(sizes, default=0.0)
    braking = max(drive.velocity / drive.acceleration, drive.turn_velocity / drive.turn_acceleration)
    return float(speed * moving(model, DRIVE, age, braking))


def moving(model: MachineModel, mover: str, age: float, braking: float) -> float:
    """For how long [s] a joint, or the tracks, may have moved at full speed: unheard, until it had stopped.

    `braking` [s]: from full speed to rest.
    """
    answer = model.response.get(mover)
    if answer is None:  # a passive joint
        return 0.0
    return max(0.0, min(age - FRESH, LEASE + answer.dead_time + answer.lag + braking / 2))
