"""Dig at a point: swing there, lower the bucket, scoop."""

from tms_kit.subtask import Machine, Params, Progress, subtask


class DigPoint(Params):
    """Where to dig."""

    plan_only: bool = False  # an input of the variant: check whether the point can be dug, without a motion
    position_with_angle: float  # must be present, as in the C++ system
    x: float  # m, base_link
    y: float  # m, base_link
    z: float  # m, base_link, ground level: the bucket goes 1 m below
    theta_w: float  # rad, wished angle of the bucket; the nearest one that can be reached is taken
    offset: float = 0.0  # m, further out


@subtask(timeout=180)
def excavate_simple(machine: Machine, want: DigPoint, progress: Progress) -> None:
    machine.excavate(progress, (want.x, want.y, want.z), want.theta_w, want.offset, want.plan_only)
