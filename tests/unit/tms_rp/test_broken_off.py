"""A stored plan that was broken off goes on where the arm stands on its path, and nowhere else."""

import numpy as np
import pytest
from trajectory_msgs.msg import JointTrajectory

from tms_config.config import CONFIGS
from tms_config.models import Box, MachineModel
from tms_config.yaml_file import parse
from tms_reason.errors import SubtaskFailed
from tms_rp.broken_off import rest
from tms_rp.kind import Moves
from tms_rp.kinds import load
from tms_rp.messages import follow
from tms_rp.reasons import Collision, GoesOn, PlanElsewhere, Told
from tms_rp.scene import Obstacle, Scene
from tms_rp.trajectory import Joints, Trajectory, TrajectorySample, trajectory
from tms_rp.ways import Ways

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
JOINTS = MODEL.joints
ASIDE = [0.2] * len(JOINTS)  # rad
A, B, C = (0.0, -0.8, 2.0, 0.8, 0.0), (0.9, -0.6, 1.5, 0.3, 0.0), (0.9, -1.0, 2.2, 1.5, 0.0)
FIRST, SECOND = trajectory(JOINTS, A, [B]), trajectory(JOINTS, B, [C])


def plan(made: Trajectory) -> JointTrajectory:
    return follow(made).trajectory


def halfway(made: Trajectory) -> TrajectorySample:
    return made.samples[len(made.samples) // 2]


def found(now: Joints, *plans: Trajectory) -> tuple[Trajectory, GoesOn]:
    made = rest(JOINTS, ASIDE, now, [plan(one) for one in plans])
    assert made is not None
    return made


def off(made: Trajectory, plans: list[Trajectory]) -> float:
    """How far [rad] a trajectory is off the path of plans at most."""
    path = np.array([sample.positions for one in plans for sample in one.samples])
    poses = np.array([sample.positions for sample in made.samples])
    return max(float(np.abs(path - pose).max(axis=1).min()) for pose in poses)


def test_it_goes_on_where_the_arm_stands() -> None:
    middle = halfway(FIRST)
    made, why = found(middle.positions, FIRST)
    assert made.samples[0].positions == middle.positions
    assert made.samples[-1].positions == pytest.approx(B, abs=1e-6)
    assert made.stops == (made.duration,) and made.duration < FIRST.duration
    assert (why.number, why.seconds) == (1, pytest.approx(middle.time, abs=0.05))
    assert off(made, [FIRST]) < 0.03


def test_the_rest_of_the_second_plan_alone() -> None:
    middle = halfway(SECOND)
    made, why = found(middle.positions, FIRST, SECOND)
    assert made.samples[-1].positions == pytest.approx(C, abs=1e-6) and len(made.stops) == 1
    assert (why.number, why.seconds) == (2, pytest.approx(middle.time, abs=0.05))
    assert off(made, [SECOND]) < 0.03


def test_the_rest_of_the_first_plan_and_the_second_one() -> None:
    made, why = found(halfway(FIRST).positions, FIRST, SECOND)
    assert why.number == 1 and len(made.stops) == 2 and made.stops[-1] == made.duration
    assert made.samples[-1].positions == pytest.approx(C, abs=1e-6)
    assert off(made, [FIRST, SECOND]) < 0.1  # the corner between them


def test_an_arm_beside_the_path_comes_back_to_it() -> None:
    place = halfway(FIRST).positions
    now = (place[0] - 0.12, place[1] + 0.1, *place[2:])
    made, _ = found(now, FIRST)
    assert made.samples[0].positions == now and made.samples[-1].positions == pytest.approx(B, abs=1e-6)
    for index, joint in enumerate(JOINTS.values()):
        assert max(abs(sample.velocities[index]) for sample in made.samples) <= joint.velocity * 1.0001
    assert all(b.time > a.time for a, b in zip(made.samples, made.samples[1:], strict=False))


def test_an_arm_elsewhere_does_not() -> None:
    place = halfway(FIRST).positions
    assert rest(JOINTS, ASIDE, (*place[:3], place[3] + 0.4, 0.0), [plan(FIRST)]) is None


def test_at_the_end_nothing_is_left() -> None:
    made, why = found(C, FIRST, SECOND)
    assert made.samples[-1].positions == pytest.approx(C, abs=1e-6) and made.duration < 0.1
    assert why.number == 2


def test_only_what_may_be_broken_off_goes_on_and_only_where_it_is_free() -> None:
    ways = Ways(MODEL, load("backhoe"))
    now, plans = halfway(FIRST).positions[:4], (plan(FIRST), plan(SECOND))
    with pytest.raises(SubtaskFailed) as refused:
        ways.plan(now, Moves((), plans=plans), Scene())
    assert refused.value.reason.find(PlanElsewhere)
    free = ways.plan(now, Moves((), plans=plans, broken_off=True), Scene())
    assert [type(note) for note in free.notes] == [GoesOn]
    wall = Obstacle(Told("wall"), Box(min=(3.5, 4.7, 0.0), max=(5.2, 6.3, 5.0)), np.eye(4))
    with pytest.raises(SubtaskFailed) as touching:
        ways.plan(now, Moves((), plans=plans, broken_off=True), Scene((wall,)))
    assert touching.value.reason.find(Collision)
