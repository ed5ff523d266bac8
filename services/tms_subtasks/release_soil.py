"""Tip the vessel to the angle of a record."""

from collections.abc import Mapping

from tms_config.models import TURNED
from tms_kit.subtask import Machine, Params, Progress, subtask


class Vessel(Params):
    """How far to raise the vessel."""

    target_angle: float  # rad, 0 lowered, negative raises

    def joint_angles(self) -> Mapping[str, float]:
        return dict.fromkeys(TURNED["set_dump_angle"], self.target_angle)


@subtask(timeout=300)
def release_soil(machine: Machine, want: Vessel, progress: Progress) -> None:
    machine.set_dump_angle(progress, want.target_angle)
