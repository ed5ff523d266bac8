"""Bring the blade to the angles of a record, and hold it there where the leaf asks for it."""

from collections.abc import Mapping

from pydantic import Field

from tms_kit.subtask import Machine, Params, Progress, subtask

BLADE = ("lift_joint", "tilt_joint", "angle_joint")  # in the order of the record


class Blade(Params):
    """Where to bring the blade."""

    goal_position: list[float] = Field(min_length=3, max_length=3)  # rad, of lift, tilt and angle
    blade_hold: bool = False  # an input of the goal: the machine goes on commanding the angles until the next goal

    def joint_angles(self) -> Mapping[str, float]:
        return dict(zip(BLADE, self.goal_position, strict=True))


@subtask(timeout=60)
def blade_control(machine: Machine, want: Blade, progress: Progress) -> None:
    machine.set_blade(progress, dict(want.joint_angles()), want.blade_hold)
