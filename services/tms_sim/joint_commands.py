"""Moves joints by commands without a goal, as machines and simulators do: angles or velocities. Pure logic."""

import math
from collections.abc import Mapping, Sequence

from tms_sim.arm import Arm

POSITION, VELOCITY = 0, 1  # com3_msgs/JointCmd.control_type; 2, effort, is the lever of a real machine
THERE = 1e-4  # rad


class JointCommands:
    """An angle stays until it is reached, a velocity until the next command: there is no time-out."""

    def __init__(self, arm: Arm, names: Mapping[str, str]) -> None:
        """`names` maps joints of the model to their names at the border, where these differ."""
        self._arm, self._own = arm, {theirs: ours for ours, theirs in names.items()}
        self.emergency = False

    def take(
        self, names: Sequence[str], control: int, position: Sequence[float], velocity: Sequence[float]
    ) -> str | None:
        """Take one JointCmd; returns why it is ignored as a whole. Unknown joints are skipped, as in the simulator."""
        if control not in (POSITION, VELOCITY):
            return f"control_type {control}: a stand-in knows 0 (position) and 1 (velocity)"
        values = position if control == POSITION else velocity
        if len(values) < len(names):
            return f"{len(values)} {'positions' if control == POSITION else 'velocities'} for {len(names)} joints"
        for name, value in zip(names, values, strict=False):
            self.move(self._own.get(name, name), value, control)
        return None

    def move(self, joint: str, value: float, control: int = POSITION) -> None:
        """Bring one joint to an angle [rad] or a velocity [rad/s], within its limits."""
        arm = self._arm
        if joint not in arm.joints or arm.joints[joint].passive or not math.isfinite(value) or self.emergency:
            return
        limits = arm.joints[joint]
        arm.targets.pop(joint, None)
        arm.speeds.pop(joint, None)
        if control == VELOCITY:
            arm.speeds[joint] = max(-limits.velocity, min(limits.velocity, value))
            return
        low, high = (-math.inf if limits.min is None else limits.min), (math.inf if limits.max is None else limits.max)
        arm.targets[joint] = max(low, min(high, value))

    def stop(self, on: bool) -> None:
        """Set the level of the emergency stop: while true, commands are ignored."""
        self.emergency = on

    def step(self) -> None:
        """Forget the angles that are reached; the arm has been stepped before."""
        arm = self._arm
        for name, servo in arm.servos.items():
            if name in arm.targets and servo.rate == 0 and abs(arm.targets[name] - servo.setpoint) < THERE:
                del arm.targets[name]
            if arm.speeds.get(name) == 0.0 and servo.rate == 0:
                del arm.speeds[name]
