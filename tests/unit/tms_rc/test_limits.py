"""A trajectory that leaves the machine's limits is refused with the joint and the bound."""

import pytest

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.reasons import BelowLimit
from tms_config.yaml_file import parse
from tms_rc.limits import TrajectoryPoint, angle_problem, escaped, pace_problem, pose_problem, problem
from tms_rc.reasons import AtJoint
from tms_reason.reason import Reason
from tms_reason.texts import text

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
JOINTS = ["swing_joint", "boom_joint"]


def words(reason: Reason | None) -> str:
    """A reason as people read it."""
    return "" if reason is None else text(reason, "en")


@pytest.mark.parametrize(
    ("joints", "points", "said"),
    [
        (JOINTS, [], "no points"),
        (["tail_joint"], [[0.0]], "there is no joint 'tail_joint'"),
        (JOINTS, [[0.0, -0.5], [0.0]], "point 1: there are 1 positions for 2 joints"),
        (["boom_joint", "boom_joint"], [[-0.5, -0.6]], "a joint is named twice"),
        (JOINTS, [[0.0, 0.5]], "boom_joint: 0.500 rad is above its limit -0.100 rad"),
        (JOINTS, [[0.0, -2.0]], "boom_joint: -2.000 rad is below its limit -1.137 rad"),
        (JOINTS, [[float("nan"), -0.5]], "swing_joint: this is not a number"),
        (JOINTS, [[0.0, float("inf")]], "boom_joint: this is not a number"),
    ],
)
def test_refused(joints: list[str], points: list[list[float]], said: str) -> None:
    assert said in words(problem(MODEL, joints, points))


SWING = MODEL.joints["swing_joint"].velocity


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ([TrajectoryPoint(1.0, [0.0], [float("nan")])], "a velocity, acceleration or effort is not a number"),
        (
            [TrajectoryPoint(5.0, [0.0], []), TrajectoryPoint(1.0, [0.1], [])],
            "point 1: its time 1.00 s is not after the one before",
        ),
        (
            [TrajectoryPoint(1.0, [0.0], []), TrajectoryPoint(1.0, [0.0], [])],
            "point 1: its time 1.00 s is not after the one before",
        ),
        ([TrajectoryPoint(-1.0, [0.0], [])], "its time -1.00 s is not after"),
        ([TrajectoryPoint(0.001, [3.0], [])], "swing_joint: it would go 3.000 rad in 0.00 s, its limit is"),
        ([TrajectoryPoint(0.0, [0.3 * SWING], [])], "rad in 0.00 s"),
        (
            [TrajectoryPoint(1.0, [0.0], []), TrajectoryPoint(2.0, [1.2 * SWING], [])],
            "point 1: swing_joint: it would go",
        ),
    ],
)
def test_a_trajectory_that_cannot_be_followed_is_refused(points: list[TrajectoryPoint], said: str) -> None:
    assert said in words(pace_problem(MODEL, ["swing_joint"], points, {"swing_joint": 0.0}))


def test_a_trajectory_at_the_limit_of_speed_is_let_through() -> None:
    points = [
        TrajectoryPoint(0.0, [0.05], [0.0]),
        TrajectoryPoint(1.0, [0.05 + SWING], [SWING, 0.0]),
        TrajectoryPoint(3.0, [0.05 - SWING], [0.0]),
    ]
    assert pace_problem(MODEL, ["swing_joint"], points, {"swing_joint": 0.0}) is None
    assert pace_problem(MODEL, ["swing_joint"], points[1:], {}) is None  # nobody knows where the joint is
    begins = [TrajectoryPoint(0.0, [6.0 * SWING], [])]  # a simulated machine that stands since a moment
    assert pace_problem(MODEL, ["swing_joint"], begins, {"swing_joint": 0.0}, speed=40.0) is None


def test_a_joint_that_turns_for_ever_has_no_bound() -> None:
    assert problem(MODEL, JOINTS, [[100.0, -0.5]]) is None


def test_a_joint_that_sags_may_come_back_but_go_no_further() -> None:
    sagging = {"boom_joint": 0.05}  # its limit is -0.1
    assert problem(MODEL, JOINTS, [[0.0, 0.05], [0.0, -0.5]], sagging) is None
    assert "boom_joint" in words(problem(MODEL, JOINTS, [[0.0, 0.06]], sagging))
    assert "boom_joint" in words(problem(MODEL, JOINTS, [[0.0, -2.0]], sagging))  # the other limit


def test_a_moving_joint_far_beyond_its_limit_is_seen() -> None:
    start = {"boom_joint": -0.5}
    assert escaped(MODEL, {"boom_joint": -0.09}, start) is None
    assert "above its limit" in words(escaped(MODEL, {"boom_joint": 0.0}, start))
    assert escaped(MODEL, {"boom_joint": 0.0}, {"boom_joint": 0.05}) is None  # it began further out


CARRIER = parse(CONFIGS / "machines" / "mst110cr.yaml", MachineModel)


def test_angles_of_bed_and_body_are_checked_before_they_leave() -> None:
    assert angle_problem(CARRIER, "set_dump_angle", -1.0, {}) is None
    assert angle_problem(CARRIER, "set_swing_angle", 5.0, {}) is None  # turns for ever
    said = angle_problem(CARRIER, "set_dump_angle", -1.2, {})
    assert isinstance(said, AtJoint) and isinstance(said.why, BelowLimit)
    assert (said.joint, said.why.angle) == ("dump_joint", -1.2)
    assert "is not a number" in words(angle_problem(CARRIER, "set_swing_angle", float("nan"), {}))
    assert "no joint for set_dump_angle" in words(angle_problem(MODEL, "set_dump_angle", 0.0, {}))


@pytest.mark.parametrize(
    ("poses", "said"),
    [
        ([], "no pose"),
        ([(0, 0, 0, 0, 0, 0, 1), (0, float("inf"), 0, 0, 0, 0, 1)], "pose 1: this is not a number"),
        ([(0, 0, 0, 0, 0, 0, 0)], "pose 0: its quaternion has the length 0.000"),
    ],
)
def test_poses_that_lead_nowhere(poses: list[tuple[float, ...]], said: str) -> None:
    assert said in words(pose_problem(poses))
    assert pose_problem([(1.0, 2.0, 0.0, 0.0, 0.0, 0.6, 0.8)]) is None
