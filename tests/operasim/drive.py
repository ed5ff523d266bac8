"""A joint as the physics engine drives it. Pure; angles in rad, torques in N m."""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class DriveModel:
    """Constants of a joint: torque = stiffness * (target - position) - damping * velocity, up to a limit."""

    stiffness: float  # N m/rad
    damping: float  # N m s/rad
    torque: float  # N m, limit
    inertia: float  # kg m2
    gravity: float = 0.0  # N m, what pulls at the joint
    low: float = -math.inf  # rad, end stops
    high: float = math.inf


class Drive:
    """A joint in motion. The engine integrates implicitly: its damping of 1e8 would be unstable otherwise."""

    def __init__(self, model: DriveModel, target: float) -> None:
        """All joints begin at 0, wherever their target and their end stops are."""
        self.model = model
        self.stiffness, self.damping = model.stiffness, model.damping
        self.target = target  # not limited to the end stops
        self.position = self.velocity = 0.0

    def step(self, seconds: float) -> None:
        """Move on by one step of the engine."""
        model, error = self.model, self.target - self.position
        pulled = self.velocity * model.inertia + seconds * (self.stiffness * error + model.gravity)
        velocity = pulled / (model.inertia + seconds * (self.damping + seconds * self.stiffness))
        torque = self.stiffness * (error - seconds * velocity) - self.damping * velocity
        if abs(torque) > model.torque:
            limited = math.copysign(model.torque, torque) + model.gravity
            velocity = self.velocity + seconds * limited / model.inertia
        self._move(velocity, seconds)

    def _move(self, velocity: float, seconds: float) -> None:
        """Stop hard at the ends. From outside them, as at the start, it may only come in."""
        wanted = self.position + velocity * seconds
        held = min(max(wanted, min(self.model.low, self.position)), max(self.model.high, self.position))
        self.velocity = velocity if held == wanted else 0.0
        self.position = held
