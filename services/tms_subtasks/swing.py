"""Turn the upper body to the angle of a record."""

from tms_core.subtask import Machine, Params, Progress, subtask


class Heading(Params):
    target_angle: float  # rad, upper body against the tracks


@subtask(timeout=300)
def swing(machine: Machine, want: Heading, progress: Progress) -> None:
    machine.set_swing_angle(progress, want.target_angle)
