"""How a planner is set by primitives of the C++ system's version 6, as far as ours can honour it."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from tms_reason.errors import SubtaskFailed
from tms_rp.reasons import SettingNotHonoured

NUMBERS: Mapping[str, Callable[[float], bool]] = {  # what our planner takes
    "goal_position_tolerance": lambda metres: metres >= 0,  # it goes to the goal itself
    "goal_orientation_tolerance": lambda angle: 0 < angle <= math.pi / 2,
    "goal_joint_tolerance": lambda angle: angle >= 0,
    "max_velocity_scaling_factor": lambda share: 0 < share <= 1,
    "max_acceleration_scaling_factor": lambda share: 0 < share <= 1,
    "planning_time": lambda seconds: seconds == Settings.planning_time,  # it is bounded by its steps
    "num_planning_attempts": lambda count: count == Settings.num_planning_attempts,  # all give the same way
}
TEXTS = ("planner_id", "planning_pipeline_id")


@dataclass(frozen=True)
class Settings:
    """The values, under the names of TmsRpExcavatorParamGet; the shares are those of records without a scale."""

    goal_position_tolerance: float = 0.01  # m
    goal_orientation_tolerance: float = 0.05  # rad that a pose may point out of the arm's plane
    goal_joint_tolerance: float = 0.01  # rad
    max_velocity_scaling_factor: float = 0.5
    max_acceleration_scaling_factor: float = 0.5
    planning_time: float = 5.0  # s, MoveIt's usual one: our planner's searches end sooner
    num_planning_attempts: int = 1
    planner_id: str = "RRTConnectkConfigDefault"
    planning_pipeline_id: str = "ompl"

    def changed(self, request: Any) -> "Settings":
        """The settings after a request; a negative number, NaN and an empty text leave a value.

        Raises:
            SubtaskFailed: SettingNotHonoured; then none is changed.
        """
        values: dict[str, Any] = {}
        for name, honoured in NUMBERS.items():
            number = getattr(request, name)
            if number >= 0:  # also false for NaN
                if not honoured(number):
                    raise SubtaskFailed(SettingNotHonoured(name, f"{number:g}"))
                values[name] = number
        for name in TEXTS:
            text = getattr(request, name)
            if text and text != getattr(self, name):
                raise SubtaskFailed(SettingNotHonoured(name, text))
        return replace(self, **values)

    def fill(self, response: Any) -> None:
        """Write the values into a response."""
        for name in (*NUMBERS, *TEXTS):
            setattr(response, name, getattr(self, name))
