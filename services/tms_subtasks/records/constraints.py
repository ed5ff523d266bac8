"""Constraints of a plan in records of the C++ system's version 6, with MoveIt's names: those of joints are kept."""

from collections.abc import Callable
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, model_validator
from trajectory_msgs.msg import JointTrajectory

from tms_machine.joint_ranges import left
from tms_machine.reasons import NotHonoured
from tms_reason.errors import SubtaskFailed
from tms_reason.validation import Wrong
from tms_subtasks.records.plans import end

BASE = 999.0  # as the position of a constraint: where the joint is when the plan begins


class _Joint(BaseModel):
    model_config = ConfigDict(frozen=True, allow_inf_nan=False, extra="ignore")

    joint_name: str
    position: float  # rad, or BASE
    tolerance_above: float = Field(ge=0)  # rad
    tolerance_below: float = Field(ge=0)  # rad


class Constraints(BaseModel):
    """Ranges that joints must not leave on the way; every other kind of constraint is refused."""

    model_config = ConfigDict(frozen=True, extra="allow")

    joint_constraints: list[_Joint] = []

    @model_validator(mode="before")
    @classmethod
    def _honoured(cls, given: Any) -> Any:
        """Our planner goes straight in joint space: it looks for no other way, but its way is checked."""
        names = given if isinstance(given, dict) else {}
        others = tuple(
            str(name) for name, value in names.items() if value and name not in ("joint_constraints", "name")
        )
        if others:
            raise Wrong(NotHonoured(others))
        return given

    def check(self, plan: JointTrajectory, previous: JointTrajectory | None, now: Callable[[str], float]) -> None:
        """Refuse a plan on which a joint leaves its range; `now` tells the present angle of a joint [rad].

        Raises:
            SubtaskFailed: PathLeavesConstraint, or NotHonoured: the plan does not have the joint.
        """
        base = end(previous) if previous is not None else {}
        for one in self.joint_constraints:
            middle = one.position if one.position != BASE else base.get(one.joint_name)
            middle = now(one.joint_name) if middle is None else middle
            why = left(plan, one.joint_name, middle - one.tolerance_below, middle + one.tolerance_above)
            if why is not None:
                raise SubtaskFailed(why)
