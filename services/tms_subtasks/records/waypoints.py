"""Targets of an arm in records of the C++ system's version 6: one waypoint, and how fast to go there."""

import math
from collections.abc import Callable, Mapping
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator
from trajectory_msgs.msg import JointTrajectory

from tms_kit.subtask import Params
from tms_machine.reasons import MoreThanOneTurn, OneWaypoint
from tms_reason.validation import Wrong
from tms_subtasks.records.constraints import Constraints
from tms_subtasks.records.plans import end

Goal = dict[str, float] | tuple[float, float, float, float]  # joint angles [rad], or x, y, z [m], theta_w [rad]
SCALE = 0.5  # of velocity and acceleration where a record gives none: the C++ system's


class _Pose(BaseModel):
    model_config = ConfigDict(frozen=True, allow_inf_nan=False, extra="ignore")

    x: float
    y: float
    z: float
    theta_w: float


class _Point(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore")

    type: Literal["joint_values_absolute", "joint_values_relative", "pose"]
    data: dict[str, float]

    @model_validator(mode="after")
    def _complete(self) -> "_Point":
        if self.type == "pose":
            _Pose.model_validate(self.data)
        for angle in self.data.values() if self.type != "pose" else ():
            # 999 asks the C++ system to search for the furthest angle, other large ones to level the bucket.
            if not abs(angle) <= math.tau:
                raise Wrong(MoreThanOneTurn(f"{math.degrees(angle):g}"))
        return self


class Waypoint(Params):
    """Where the arm shall go."""

    planning_group: str  # the arm's name in the C++ system's planner; must be present, as there
    waypoints: list[_Point]  # one
    velocity_scale: float = Field(default=SCALE, gt=0, le=1)
    acceleration_scale: float = Field(default=SCALE, gt=0, le=1)
    constraints: Constraints = Constraints()
    previous_target_record_name: str = ""  # an input of the goal: the record whose plan ends where this one begins

    @field_validator("waypoints")
    @classmethod
    def _one(cls, points: list[_Point]) -> list[_Point]:
        if len(points) != 1:
            raise Wrong(OneWaypoint(len(points)))
        return points

    def joint_angles(self) -> Mapping[str, float]:
        point = self.waypoints[0]
        return point.data if point.type == "joint_values_absolute" else {}

    def goal(self, previous: JointTrajectory | None, now: Callable[[str], float]) -> Goal:
        """The target; `now` tells the present angle of a joint [rad], where no plan goes before."""
        point = self.waypoints[0]
        if point.type == "pose":
            return point.data["x"], point.data["y"], point.data["z"], point.data["theta_w"]
        if point.type == "joint_values_absolute":
            return dict(point.data)
        base = end(previous) if previous is not None else {}
        return {name: (base[name] if name in base else now(name)) + by for name, by in point.data.items()}
