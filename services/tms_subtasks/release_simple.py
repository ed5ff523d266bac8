"""Open the bucket where it is, or over the place of the record: there in the same motion, with the bucket level."""

from collections.abc import Mapping

from pydantic import model_validator

from tms_kit.subtask import Machine, Params, Progress, subtask
from tms_machine.reasons import FieldMissing
from tms_reason.validation import Wrong

PLACE = ("x", "y", "z", "theta_w")


class Opening(Params):
    """How far to open the bucket, and where."""

    target_angle: float  # rad, bucket joint when open
    position_with_angle: float = 0.0  # flag: over the place of the next four fields, else where the arm is
    x: float | None = None  # m, base_link
    y: float | None = None  # m, base_link
    z: float | None = None  # m, base_link, of the bucket's tip
    theta_w: float | None = None  # rad; the nearest angle that holds soil is taken

    @model_validator(mode="after")
    def _whole(self) -> "Opening":
        missing = [name for name in PLACE if getattr(self, name) is None]
        if self.position_with_angle > 0.5 and missing:
            raise Wrong(FieldMissing(missing[0]))
        return self

    def place(self) -> tuple[float, ...]:
        """The fields of the place; none without the flag."""
        return tuple(getattr(self, name) for name in PLACE) if self.position_with_angle > 0.5 else ()

    def joint_angles(self) -> Mapping[str, float]:
        return {"bucket_joint": self.target_angle}


@subtask(timeout=180)
def release_simple(machine: Machine, want: Opening, progress: Progress) -> None:
    machine.release_soil(progress, want.target_angle, want.place())
