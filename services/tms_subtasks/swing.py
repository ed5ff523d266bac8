"""Turn the upper body to the angle of a record."""

from collections.abc import Mapping

from tms_config.models import TURNED
from tms_kit.subtask import Machine, Params, Progress, subtask


class Heading(Params):
    """Where to turn the upper body."""

    target_angle: float  # rad, upper body against the tracks

    def joint_angles(self) -> Mapping[str, float]:
        return dict.fromkeys(TURNED["set_swing_angle"], self.target_angle)


@subtask(timeout=300)
def swing(machine: Machine, want: Heading, progress: Progress) -> None:
    machine.set_swing_angle(progress, want.target_angle)
