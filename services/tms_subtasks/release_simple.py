"""Open the bucket over the dumping place."""

from tms_core.subtask import Machine, Params, Progress, subtask


class Opening(Params):
    target_angle: float  # rad, bucket joint when open


@subtask(timeout=120)
def release_simple(machine: Machine, want: Opening, progress: Progress) -> None:
    machine.release_soil(progress, want.target_angle)
