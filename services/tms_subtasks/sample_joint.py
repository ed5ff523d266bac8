"""Move one joint of the arm to the angle of a record; the others stay."""

import math
from collections.abc import Mapping
from typing import Any

from pydantic import field_validator, model_validator

from tms_kit.subtask import Machine, Params, Progress, subtask
from tms_machine.reasons import FieldMissing, MoreThanOneTurn
from tms_reason.validation import Wrong


class Angle(Params):
    """Which joint to bring to which angle."""

    joint: str  # an input of the variant
    field: str  # an input of the variant: the field of the record that holds the angle
    angle: float  # deg, from that field

    @model_validator(mode="before")
    @classmethod
    def _pick(cls, fields: dict[str, Any]) -> dict[str, Any]:
        if fields.get("field") not in fields:
            raise Wrong(FieldMissing(str(fields.get("field"))))
        return {**fields, "angle": fields[fields["field"]]}

    @field_validator("angle")
    @classmethod
    def _within_a_turn(cls, angle: float) -> float:
        if abs(angle) > 360.0:  # which means "keep the present angle" to the planner
            raise Wrong(MoreThanOneTurn(f"{angle:g}"))
        return angle

    def joint_angles(self) -> Mapping[str, float]:
        return {self.joint: math.radians(self.angle)}


@subtask(timeout=120)
def sample_joint(machine: Machine, want: Angle, progress: Progress) -> None:
    machine.joint(want.joint)
    machine.change_pose(progress, joints={want.joint: math.radians(want.angle)})
