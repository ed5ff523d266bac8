"""Stored plans: executed as one trajectory where they fit the arm, refused with the reason where they do not."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from trajectory_msgs.msg import JointTrajectory

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_machine.stamps import duration
from tms_reason.errors import SubtaskFailed
from tms_rp.kinds.backhoe.planner import NAMES
from tms_rp.messages import follow
from tms_rp.plans import START, one_trajectory, scaled, start_of, without_stops
from tms_rp.reasons import JointBroken, PlanBroken, PlanElsewhere, PlanLacks, PlanTooFast, PlanWrong
from tms_rp.trajectory import trajectory

JOINTS = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel).joints
A, B, C = (0.0, -0.8, 2.0, 0.8, 0.0), (0.5, -0.6, 1.5, 0.3, 0.0), (0.5, -0.9, 2.2, 1.5, 0.0)


def plan(*poses: tuple[float, ...]) -> JointTrajectory:
    return follow(trajectory(JOINTS, poses[0], poses[1:])).trajectory


def refusal(*plans: JointTrajectory, now: tuple[float, ...] = A) -> PlanWrong:
    with pytest.raises(SubtaskFailed) as caught:
        one_trajectory(JOINTS, now, plans)
    assert isinstance(caught.value.reason, PlanWrong)
    return caught.value.reason


def test_plans_one_behind_the_other_are_one_trajectory() -> None:
    first, second = trajectory(JOINTS, A, [B]), trajectory(JOINTS, B, [C])
    made = one_trajectory(JOINTS, A, [plan(A, B), plan(B, C)])
    assert made.names == tuple(JOINTS)
    assert made.samples[0].positions == A and made.samples[-1].positions == C
    assert made.stops == pytest.approx((first.duration, first.duration + second.duration), abs=1e-6)
    assert all(after.time > before.time for before, after in pairwise(made.samples))


def test_an_arm_that_sags_goes_to_the_begin_of_its_plan_first() -> None:
    now = (A[0], A[1] + 0.05, *A[2:])
    made = one_trajectory(JOINTS, now, [plan(A, B)])
    assert made.samples[0].positions == now and made.samples[-1].positions == B
    steps = [abs(b.positions[1] - a.positions[1]) / (b.time - a.time) for a, b in pairwise(made.samples)]
    assert max(steps) <= JOINTS["boom_joint"].velocity * 1.01


def test_a_plan_that_begins_elsewhere_is_refused() -> None:
    why = refusal(plan(A, B), now=(A[0] + START + 0.01, *A[1:])).why
    assert why == PlanElsewhere("swing_joint", A[0], A[0] + START + 0.01)
    second = refusal(plan(A, B), plan(A, C))  # it does not go on where the first one ends
    assert second.number == 2 and isinstance(second.why, PlanElsewhere)


def test_an_arm_that_sags_beyond_a_limit_comes_back_and_goes_no_further() -> None:
    low = JOINTS["boom_joint"].min
    assert low is not None
    sagged = (A[0], low - 0.03, *A[2:])
    made = one_trajectory(JOINTS, sagged, [plan(sagged, B)])
    assert made.samples[-1].positions == B
    why = refusal(plan(sagged, B), now=(A[0], low - 0.01, *A[2:])).why
    assert isinstance(why, JointBroken) and why.joint == "boom_joint"


def broken(change: Callable[[JointTrajectory], object]) -> PlanWrong:
    made = plan(A, B)
    change(made)
    return refusal(made)


def test_a_plan_beyond_a_limit_is_refused() -> None:
    def out(made: JointTrajectory) -> None:
        made.points[3].positions[1] = 0.5

    def fast(made: JointTrajectory) -> None:
        for point in made.points:
            point.time_from_start = duration((point.time_from_start.sec + point.time_from_start.nanosec * 1e-9) / 2)

    def hard(made: JointTrajectory) -> None:
        made.points[3].accelerations[0] = 10 * JOINTS["swing_joint"].acceleration

    out_of = broken(out).why
    assert isinstance(out_of, JointBroken) and out_of.joint == "boom_joint"
    assert isinstance(broken(fast).why, PlanTooFast)
    assert isinstance(broken(hard).why, PlanTooFast)


def test_what_is_no_plan_is_refused() -> None:
    def short(made: JointTrajectory) -> None:
        made.points = made.points[:1]

    def odd(made: JointTrajectory) -> None:
        made.points[2].positions = [float("nan")] * 5

    def back(made: JointTrajectory) -> None:
        made.points[3].time_from_start = made.points[1].time_from_start

    def moving(made: JointTrajectory) -> None:
        made.points = made.points[: len(made.points) // 2]

    assert [broken(change).why for change in (short, odd, back, moving)] == [PlanBroken()] * 4

    def nameless(made: JointTrajectory) -> None:
        made.joint_names = ["swing_joint", "boom_joint", "arm_joint", "elbow_joint", "bucket_end_joint"]

    assert broken(nameless).why == PlanLacks(("bucket_joint",))


def test_a_plan_may_leave_out_a_joint_that_no_command_moves() -> None:
    made = plan(A, B)
    made.joint_names = made.joint_names[:4]
    for point in made.points:
        point.positions, point.velocities, point.accelerations = point.positions[:4], point.velocities[:4], []
    assert one_trajectory(JOINTS, A, [made]).samples[-1].positions == B


def test_a_plan_goes_on_where_the_one_before_ends() -> None:
    assert start_of(plan(A, B), NAMES) == B[:4]
    assert start_of(JointTrajectory(), NAMES) is None
    made = plan(A, B)
    made.joint_names = ["swing_joint", "boom_joint", "arm_joint", "elbow_joint", "bucket_end_joint"]
    with pytest.raises(SubtaskFailed):
        start_of(made, NAMES)


def test_scales_are_shares_of_the_limits() -> None:
    slow, fast = trajectory(scaled(JOINTS, 0.5, 0.5), A, [B]), trajectory(JOINTS, A, [B])
    assert slow.duration > 1.3 * fast.duration
    swing = max(abs(sample.velocities[0]) for sample in trajectory(scaled(JOINTS, 0.1, 1.0), A, [B]).samples)
    assert swing <= 0.1 * JOINTS["swing_joint"].velocity * 1.000001


def test_plans_whose_ends_meet_run_without_a_stop_as_fast_as_they_are() -> None:
    slow, fast = (follow(trajectory(scaled(JOINTS, share, 1.0), a, [b])).trajectory
                  for share, a, b in ((0.1, A, B), (1.0, B, C)))  # fmt: skip
    made = one_trajectory(JOINTS, A, [slow, fast])
    found = without_stops(JOINTS, made)
    assert found.samples[0].positions == A and found.samples[-1].positions == pytest.approx(C, abs=1e-6)
    assert len(found.stops) == 2 and found.stops[-1] == found.duration
    inner = [sample for sample in found.samples if 0.6 < sample.time < found.duration - 0.6]
    assert min(max(map(abs, sample.velocities)) for sample in inner) > 0.02
    for index, joint in enumerate(JOINTS.values()):
        speeds = [(sample.time, abs(sample.velocities[index])) for sample in found.samples]
        assert max(speed for _, speed in speeds) <= joint.velocity * 1.0001
        assert max(abs(sample.accelerations[index]) for sample in found.samples) <= joint.acceleration * 1.0001
        assert found.stops[0] > 0.75 * made.stops[0]
        before = max(speed for at, speed in speeds if at < found.stops[0] - 0.8)
        assert before <= 0.1 * joint.velocity * 1.02  # the first plan stays slow


def test_the_path_of_plans_stays_near_them_away_from_their_ends() -> None:
    made = one_trajectory(JOINTS, A, [plan(A, B), plan(B, C)])
    found = without_stops(JOINTS, made)
    assert found.duration < made.duration
    corner = np.array([sample.positions for sample in found.samples])
    assert np.abs(corner - np.array(B)).max(axis=1).min() < 0.15
    path = np.array([sample.positions for sample in made.samples])
    assert max(np.abs(path - pose).max(axis=1).min() for pose in corner) < 0.15
