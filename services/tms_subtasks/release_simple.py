"""Open the bucket over the dumping place."""

from collections.abc import Mapping

from tms_kit.subtask import Machine, Params, Progress, subtask


class Opening(Params):
    """How far to open the bucket."""

    target_angle: float  # rad, bucket joint when open

    def joint_angles(self) -> Mapping[str, float]:
        return {"bucket_joint": self.target_angle}


@subtask(timeout=120)
def release_simple(machine: Machine, want: Opening, progress: Progress) -> None:
    machine.release_soil(progress, want.target_angle)
