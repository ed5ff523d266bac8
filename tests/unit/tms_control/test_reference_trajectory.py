"""Which trajectories can be followed, and how a reference interpolates."""

import math

import pytest

from tms_config.models import Joint
from tms_control.reasons import OtherJoints, PointNotFinite, PointTooEarly, PointUnfit, TrajectoryEmpty
from tms_control.reference_trajectory import INVALID_GOAL, INVALID_JOINTS, Knot, ReferenceTrajectory, refusal
from tms_reason.reason import Reason

JOINTS = {
    "swing": Joint(velocity=1, acceleration=1, jerk=1),
    "boom": Joint(min=-1, max=1, velocity=1, acceleration=1, jerk=1),
}
NAMES = ("swing", "boom")
START = Knot(0.0, (0.0, 0.0), (0.0, 0.0))


def line(*times: float) -> list[Knot]:
    return [Knot(t, (t, t)) for t in times]


@pytest.mark.parametrize(
    ("names", "points", "refused"),
    [
        (("boom",), line(1), (INVALID_JOINTS, OtherJoints(("boom",), NAMES))),
        ((), line(1), (INVALID_JOINTS, OtherJoints((), NAMES))),
        (("boom", "boom"), line(1), (INVALID_JOINTS, OtherJoints(("boom", "boom"), NAMES))),
        (NAMES, [], (INVALID_GOAL, TrajectoryEmpty())),
        (NAMES, line(1, 1), (INVALID_GOAL, PointTooEarly(1, 1.0))),
        (NAMES, line(2, 1), (INVALID_GOAL, PointTooEarly(1, 1.0))),
        (NAMES, line(-1), (INVALID_GOAL, PointTooEarly(0, -1.0))),
        (NAMES, [Knot(1, (0.0,))], (INVALID_GOAL, PointUnfit(0))),
        (NAMES, [Knot(1, (0.0, 0.0), (1.0,))], (INVALID_GOAL, PointUnfit(0))),
        (NAMES, [Knot(1, (0.0, math.nan))], (INVALID_GOAL, PointNotFinite(0))),
    ],
)
def test_refused(names: tuple[str, ...], points: list[Knot], refused: tuple[int, Reason]) -> None:
    assert refusal(JOINTS, names, points) == refused


def test_accepted_in_any_order_of_joints() -> None:
    assert refusal(JOINTS, ("boom", "swing"), line(0, 1)) is None


def test_straight_from_where_the_arm_is() -> None:
    path = ReferenceTrajectory(JOINTS, START, ("boom", "swing"), [Knot(2.0, (0.5, 2.0))])
    assert path.at(0.0) == (0, 0)
    assert path.at(1.0) == (1.0, 0.25)
    assert path.at(9.0) == path.end == (2.0, 0.5)


def test_cubic_keeps_positions_and_velocities() -> None:
    path = ReferenceTrajectory(
        JOINTS, START, NAMES, [Knot(0, (0, 0), (0, 0)), Knot(2, (1, 1), (0.5, 0)), Knot(4, (2, 1), (0, 0))]
    )
    h = 1e-6
    assert path.at(2.0) == pytest.approx((1, 1))
    for side in (-h, h):
        assert (path.at(2 + side)[0] - 1) / side == pytest.approx(0.5, abs=1e-4)
        assert (path.at(2 + side)[1] - 1) / side == pytest.approx(0.0, abs=1e-4)


def test_a_joint_that_turns_for_ever_is_not_unwound() -> None:
    now = Knot(0.0, (6.2, 0.0), (0.0, 0.0))
    path = ReferenceTrajectory(JOINTS, now, NAMES, [Knot(1.0, (0.0, 0.0)), Knot(2.0, (0.1, 0.0))])
    assert path.end[0] == pytest.approx(math.tau + 0.1)
