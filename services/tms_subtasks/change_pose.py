"""Move the arm to the joint angles, the pose or the bucket position of a record."""

from collections.abc import Mapping

from geometry_msgs.msg import Point, Pose, Quaternion

from tms_kit.subtask import Machine, Params, Progress, SubtaskFailed, subtask
from tms_machine.reasons import FieldMissing, NoFlag

ARM = ("swing_joint", "boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint")


class Target(Params):
    """One of the three flags selects the fields that are used."""

    plan_only: bool = False  # an input of the variant: check whether the target can be reached, without a motion
    trajectory: float = 0.0  # flag: joint angles [rad]
    pose: float = 0.0  # flag: position [m] and orientation, base_link
    position_with_angle: float = 0.0  # flag: position [m] and theta_w [rad], base_link
    swing_joint: float | None = None
    boom_joint: float | None = None
    arm_joint: float | None = None
    bucket_joint: float | None = None
    bucket_end_joint: float | None = None
    x: float | None = None
    y: float | None = None
    z: float | None = None
    qx: float | None = None
    qy: float | None = None
    qz: float | None = None
    qw: float | None = None
    theta_w: float | None = None

    def numbers(self, *names: str) -> list[float]:
        """The values of these fields, all of which must be present."""
        missing = [name for name in names if getattr(self, name) is None]
        if missing:
            raise SubtaskFailed(FieldMissing(missing[0]))
        return [getattr(self, name) for name in names]

    def joint_angles(self) -> Mapping[str, float]:
        if self.trajectory <= 0.5:
            return {}
        return {name: angle for name in ARM if (angle := getattr(self, name)) is not None}


@subtask(timeout=120)
def change_pose(machine: Machine, want: Target, progress: Progress) -> None:
    if want.trajectory > 0.5:
        joints = dict(zip(ARM, want.numbers(*ARM), strict=True))
        machine.change_pose(progress, joints=joints, plan_only=want.plan_only)
    elif want.pose > 0.5:
        x, y, z, *turn = want.numbers("x", "y", "z", "qx", "qy", "qz", "qw")
        orientation = Quaternion(x=turn[0], y=turn[1], z=turn[2], w=turn[3])
        pose = Pose(position=Point(x=x, y=y, z=z), orientation=orientation)
        machine.change_pose(progress, pose=pose, plan_only=want.plan_only)
    elif want.position_with_angle > 0.5:
        x, y, z, theta_w = want.numbers("x", "y", "z", "theta_w")
        machine.change_pose(progress, tip=(x, y, z, theta_w), plan_only=want.plan_only)
    else:
        raise SubtaskFailed(NoFlag(("trajectory", "pose", "position_with_angle")))
