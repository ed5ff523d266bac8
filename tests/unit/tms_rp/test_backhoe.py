"""Goals become joint targets; every refusal says why."""

import math
import re
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_reason.errors import ConfigError, SubtaskFailed
from tms_rp.kinds.backhoe.digging import excavate, release
from tms_rp.kinds.backhoe.goals import ChangePose, Dig, Emptying, LinkGoal, TipGoal, joint_goal
from tms_rp.kinds.backhoe.linkage import ArmAngles
from tms_rp.kinds.backhoe.planner import Backhoe

BACKHOE = Backhoe(parse(CONFIGS / "machines" / "zx200.yaml", MachineModel))
NOW = ArmAngles(0.0, -0.6, 1.9, 0.3)
SOIL = TipGoal(0.0798115209, -4.7382431030, 0.1016051769, 0.0)


def tips(*goals: TipGoal) -> ChangePose:
    return ChangePose(tips=goals)


def joints(**angles: float) -> ChangePose:
    return ChangePose(joints=({f"{name}_joint": angle for name, angle in angles.items()},))


# change_pose


def test_joint_targets_keep_what_they_do_not_name() -> None:
    moves = BACKHOE.change_pose(NOW, joints(swing=0.4, boom=7.0, arm=-7.0, bucket_end=0.5))
    assert moves.targets == (NOW._replace(swing=0.4),)


def test_kept_values_are_those_at_the_start() -> None:
    goal = ChangePose(joints=({"boom_joint": -0.9}, {"boom_joint": 100.0, "arm_joint": 2.0}))
    assert BACKHOE.change_pose(NOW, goal).targets[1].boom == NOW.boom


def test_swing_goes_the_short_way() -> None:
    now = NOW._replace(swing=3.0)
    (target,) = BACKHOE.change_pose(now, joints(swing=-3.0)).targets
    assert target.swing == pytest.approx(math.tau - 3.0)


@given(st.floats(-20, 20), st.floats(-6, 6))
def test_swing_never_turns_more_than_half(before: float, wanted: float) -> None:
    (target,) = BACKHOE.change_pose(NOW._replace(swing=before), joints(swing=wanted)).targets
    assert abs(target.swing - before) <= math.pi + 1e-9
    assert math.cos(target.swing - wanted) == pytest.approx(1)


def test_tip_goals_follow_each_other() -> None:
    moves = BACKHOE.change_pose(NOW, tips(TipGoal(6.0, 0.0, 0.0, 1.2), TipGoal(7.0, -2.0, -0.5, 1.4)))
    assert moves.targets[0] == pytest.approx((0.014778, -0.436543, 2.014228, -0.377684), abs=1.5e-6)
    assert moves.targets[1] == pytest.approx((-0.270469, -0.300711, 1.412891, 0.287820), abs=1.5e-6)


def test_a_full_turn_of_theta_w_is_the_same_bucket() -> None:
    turned = BACKHOE.change_pose(NOW, tips(TipGoal(6.0, 0.0, 0.0, 1.2 - math.tau)))
    assert turned.targets[0] == pytest.approx(BACKHOE.change_pose(NOW, tips(TipGoal(6, 0, 0, 1.2))).targets[0])


def dig(x: float, y: float, z: float, theta_w: float, depth: float = 1.0, drag: float = 1.0, lift: float = 0.5) -> Dig:
    return Dig(TipGoal(x, y, z, theta_w), depth, drag, lift)


def pose_of(joint_angles: ArmAngles, roll: float = 0.0, yaw: float = 0.0) -> LinkGoal:
    """Pose of bucket_end_link by the rotations of the URDF, independent of the planner's formulas."""
    x, y, z, _ = BACKHOE.linkage.tip(joint_angles)
    fixed = math.radians(32.0357 + 16.9707 - 9.20083)
    half = [(joint_angles.swing + yaw) / 2, (joint_angles.boom + joint_angles.arm + joint_angles.bucket + fixed) / 2]
    (cy, sy), (cp, sp), (cr, sr) = ((math.cos(a), math.sin(a)) for a in (*half, roll / 2))
    return LinkGoal(
        x, y, z, cy * cp * sr - sy * sp * cr, cy * sp * cr + sy * cp * sr, sy * cp * cr - cy * sp * sr,
        cy * cp * cr + sy * sp * sr,
    )  # fmt: skip


@given(st.floats(-3, 3), st.floats(-1.13, -0.11), st.floats(0.6, 2.6), st.floats(-0.6, 2.3), st.floats(-1, 1))
def test_a_link_pose_leads_back_to_its_joints(a: float, b: float, c: float, d: float, roll: float) -> None:
    goal = ChangePose(links=(pose_of(ArmAngles(a, b, c, d), roll),))
    (target,) = BACKHOE.change_pose(NOW._replace(swing=a), goal).targets
    assert target == pytest.approx((a, b, c, d), abs=1e-6)


# refusals

NAN = float("nan")
Plan = Callable[[], object]


@pytest.mark.parametrize(
    ("plan", "text"),
    [
        (lambda: BACKHOE.change_pose(NOW, ChangePose()), "ONE_TARGET: the goal gives 0 targets: .*; Give exactly one"),
        (
            lambda: BACKHOE.change_pose(NOW, ChangePose(joints=({},), tips=(SOIL,))),
            "ONE_TARGET: the goal gives 2 targets: .*; Give exactly one",
        ),
        (
            lambda: BACKHOE.change_pose(NOW, joints(boom=0.0)),
            "OUT_OF_RANGE: boom_joint 0.000 rad is above its limit -0.100 rad; Choose",
        ),
        (
            lambda: BACKHOE.change_pose(NOW, joints(hook=0.0)),
            r"NO_SUCH_JOINT: there is no joint 'hook_joint' \(there are swing",
        ),
        (lambda: BACKHOE.change_pose(NOW, joints(arm=NAN)), "FIELD_NOT_FINITE: a value is not a number"),
        (lambda: joint_goal(["a"], [1.0, 2.0]), "ANGLES_UNFIT: 2 angles for 1 joints"),
        (lambda: joint_goal(["a", "a"], [1.0, 2.0]), "NAMED_TWICE: a joint is named twice: a, a"),
        (
            lambda: BACKHOE.change_pose(NOW, tips(SOIL)),
            r"POINT_OUT_OF_RANGE: point \(0.08 m, -4.74 m, 0.10 m\) with bucket angle 0.000 rad needs "
            "boom_joint 0.138 rad is above its limit -0.100 rad; bucket_joint -2.759 rad is below its limit -0.622 rad",
        ),
        (
            lambda: BACKHOE.change_pose(NOW, tips(TipGoal(20, 0, 0, 0))),
            "OUT_OF_REACH: .* 9.67 m too far; Choose a",
        ),
        (lambda: BACKHOE.change_pose(NOW, tips(TipGoal(NAN, 0, 0, 0))), "FIELD_NOT_FINITE: a value is"),
        (
            lambda: BACKHOE.change_pose(NOW, ChangePose(links=(LinkGoal(6, 0, 1, 0, 0, 0, 0),))),
            "NO_ORIENTATION: the orientation is empty: its quaternion has the length 0.000",
        ),
        (
            lambda: BACKHOE.change_pose(NOW, ChangePose(links=(pose_of(NOW, yaw=0.4),))),
            "OUT_OF_PLANE: the orientation points -?0....? rad out of the arm's plane; turned to ",
        ),
        (lambda: excavate(BACKHOE, NOW, dig(20, 0, 0, 1.0)), "NO_ANGLE_DIGS: no bucket angle from 0 to pi digs"),
        (lambda: excavate(BACKHOE, NOW, dig(6, 0, 1, NAN)), "FIELD_NOT_FINITE: a value"),
        (lambda: excavate(BACKHOE, NOW, dig(6, 0, 1, 1.2, drag=NAN)), "FIELD_NOT_FINITE: a value"),
        (
            lambda: excavate(BACKHOE, NOW, dig(6, 0, 1, 1.2, depth=0.0)),
            "DIG_UNFIT: depth 0.00 m must be above 0, drag ",
        ),
        (lambda: excavate(BACKHOE, NOW, dig(6, 0, 1, 1.2, lift=-0.1)), "DIG_UNFIT: "),
        (
            lambda: release(BACKHOE, NOW, Emptying(-1.0)),
            "OUT_OF_RANGE: bucket_joint -1.000 rad is below its limit -0.622 rad",
        ),
        (lambda: release(BACKHOE, NOW, Emptying(NAN)), "FIELD_NOT_FINITE: a value"),
        (lambda: release(BACKHOE, NOW, Emptying(0.0, TipGoal(20, 0, 3, 3.0))), "NO_ANGLE_DIGS: "),
    ],
)
def test_refusals(plan: Plan, text: str) -> None:
    with pytest.raises(SubtaskFailed) as caught:
        plan()
    message = str(caught.value)
    assert re.match(text, message), message
    assert "\n" not in message


def test_a_machine_file_without_an_arm(model: MachineModel) -> None:
    bare = model.model_copy(update={"joints": {}})
    with pytest.raises(ConfigError, match="a backhoe needs swing_joint, boom_joint"):
        Backhoe(bare)


def test_a_joint_left_outside_its_limits_may_stay() -> None:
    sagged = NOW._replace(boom=0.02)
    assert BACKHOE.change_pose(sagged, joints(swing=1.0)).targets[0].boom == 0.02
