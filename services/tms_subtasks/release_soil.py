"""Tip the vessel to the angle of a record."""

from tms_core.subtask import Machine, Params, Progress, subtask


class Vessel(Params):
    target_angle: float  # rad, 0 lowered, negative raises


@subtask(timeout=300)
def release_soil(machine: Machine, want: Vessel, progress: Progress) -> None:
    machine.set_dump_angle(progress, want.target_angle)
