"""Dig at a point in one motion: swing there, penetrate, drag, curl, lift with the bucket level."""

from pydantic import Field

from tms_kit.subtask import Machine, Params, Progress, subtask


class DigPoint(Params):
    """Where to dig, and how; without the last three as Excavate.action has them."""

    plan_only: bool = False  # an input of the variant: check whether the point can be dug, without a motion
    position_with_angle: float  # must be present, as in the C++ system
    x: float  # m, base_link
    y: float  # m, base_link
    z: float  # m, base_link, ground level
    theta_w: float  # rad, wished angle of the bucket; the nearest one that can be reached is taken
    offset: float = 0.0  # m, further out
    depth: float | None = Field(default=None, gt=0)  # m below the ground
    drag: float | None = Field(default=None, ge=0)  # m towards the machine, at that depth
    lift: float | None = Field(default=None, ge=0)  # m between the ground and the bucket at the end


@subtask(timeout=180)
def excavate_simple(machine: Machine, want: DigPoint, progress: Progress) -> None:
    given = {"depth": want.depth, "drag": want.drag, "lift": want.lift}
    shape = {name: value for name, value in given.items() if value is not None}
    machine.excavate(progress, (want.x, want.y, want.z), want.theta_w, want.offset, want.plan_only, **shape)
