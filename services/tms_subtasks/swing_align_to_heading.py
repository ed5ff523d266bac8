"""Turn the upper body in line with the tracks, forward or backward, whichever is nearer."""

import math

from tms_kit.subtask import Machine, Params, Progress, subtask


class Body(Params):
    """Which joint to turn."""

    joint: str  # an input of the variant: the joint that turns the upper body


@subtask(timeout=300)
def swing_align_to_heading(machine: Machine, want: Body, progress: Progress) -> None:
    now = math.remainder(machine.angle_of(want.joint), math.tau)
    machine.set_swing_angle(progress, 0.0 if abs(now) <= math.pi / 2 else math.copysign(math.pi, now))
