"""Plans of an arm in records: the field `plan`, in the form of the C++ system's version 6."""

from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_machine.reasons import BadRecord
from tms_machine.stamps import duration
from tms_reason.errors import SubtaskFailed
from tms_reason.validation import explain

DIGITS = 6  # of angles [rad] and times [s] in records: a micrometre at the bucket


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, allow_inf_nan=False, extra="ignore")


class _Time(_Part):
    sec: int = Field(ge=0, lt=2**31)
    nanosec: int = Field(ge=0, lt=10**9)


class _Point(_Part):
    positions: list[float]
    velocities: list[float] = []
    accelerations: list[float] = []
    time_from_start: _Time


class _Trajectory(_Part):
    joint_names: list[str]
    points: list[_Point]


class _Plan(_Part):
    joint_trajectory: _Trajectory


def document(plan: JointTrajectory) -> dict[str, Any]:
    """A plan as a record holds it."""
    points = [
        {
            "positions": _short(point.positions),
            "velocities": _short(point.velocities),
            "accelerations": _short(point.accelerations),
            "time_from_start": {"sec": point.time_from_start.sec, "nanosec": point.time_from_start.nanosec},
        }
        for point in plan.points
    ]
    return {"joint_trajectory": {"joint_names": list(plan.joint_names), "points": points}}


def stored(fields: Mapping[str, Any], record: str) -> JointTrajectory | None:
    """The plan in the fields of a record; None if it has none.

    Raises:
        SubtaskFailed: BadRecord, it is no plan.
    """
    if not fields.get("plan"):
        return None
    try:
        found = _Plan.model_validate(fields["plan"]).joint_trajectory
    except ValidationError as error:
        raise SubtaskFailed(BadRecord(record, explain(error))) from None
    points = [
        JointTrajectoryPoint(
            positions=point.positions,
            velocities=point.velocities,
            accelerations=point.accelerations,
            time_from_start=duration(point.time_from_start.sec + point.time_from_start.nanosec * 1e-9),
        )
        for point in found.points
    ]
    return JointTrajectory(joint_names=found.joint_names, points=points) if points else None


def end(plan: JointTrajectory) -> dict[str, float]:
    """The joint angles [rad] at the end of a plan."""
    return dict(zip(plan.joint_names, plan.points[-1].positions, strict=False))


def _short(numbers: Sequence[float]) -> list[float]:
    return [round(number, DIGITS) for number in numbers]
