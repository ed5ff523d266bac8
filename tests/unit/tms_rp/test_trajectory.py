"""Trajectories keep every limit, arrive where they should, and stop between moves."""

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_config.config import CONFIGS
from tms_config.models import Joint, MachineModel
from tms_config.yaml_file import parse
from tms_reason.errors import SubtaskFailed
from tms_rp import trajectory as module
from tms_rp.trajectory import TrajectorySample, trajectory

JOINTS = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel).joints

pose = st.tuples(
    st.floats(-7, 7), st.floats(-1.137, -0.1), st.floats(0.594, 2.687), st.floats(-0.622, 2.372), st.just(0.0)
)


def outside(name: str, joint: Joint, index: int, samples: tuple[TrajectorySample, ...]) -> list[str]:
    found = []
    for before, now in pairwise(samples):
        jerk = (now.accelerations[index] - before.accelerations[index]) / (now.time - before.time)
        low, high = (-math.inf if joint.min is None else joint.min), (math.inf if joint.max is None else joint.max)
        if not low - 1e-6 <= now.positions[index] <= high + 1e-6:
            found.append(f"{name} position")
        if abs(now.velocities[index]) > joint.velocity * 1.000001:
            found.append(f"{name} velocity")
        if abs(now.accelerations[index]) > joint.acceleration * 1.000001:
            found.append(f"{name} acceleration")
        if abs(jerk) > joint.jerk * 1.001:
            found.append(f"{name} jerk")
    return found


@given(pose, st.lists(pose, min_size=1, max_size=3))
def test_random_plans_keep_all_limits(start: tuple[float, ...], targets: list[tuple[float, ...]]) -> None:
    made = trajectory(JOINTS, start, targets)
    for index, (name, joint) in enumerate(JOINTS.items()):
        assert outside(name, joint, index, made.samples) == []
    assert made.samples[0].positions == pytest.approx(start, abs=1e-8)
    assert made.samples[-1].positions == pytest.approx(targets[-1], abs=1e-8)
    gaps = [b.time - a.time for a, b in pairwise(made.samples)]
    assert min(gaps) > 0 and max(gaps) <= module.STEP + 1e-9


START, NEAR, FAR = (0, -0.5, 1.5, 0.5, 0), (0.5, -0.5, 1.5, 0.5, 0), (1.0, -0.9, 2.0, 1.7, 0)


def test_it_rests_at_every_target() -> None:
    made = trajectory(JOINTS, START, [NEAR, FAR])
    at = {sample.time: sample for sample in made.samples}
    for stop, target in zip(made.stops, (NEAR, FAR), strict=True):
        assert at[stop].positions == target
        assert at[stop].velocities == at[stop].accelerations == (0, 0, 0, 0, 0)


def test_all_joints_arrive_together() -> None:
    made = trajectory(JOINTS, START, [FAR])
    late = made.samples[-3]
    assert all(v != 0 for v in late.velocities[:4])


def test_samples_are_derivatives_of_each_other() -> None:
    made = trajectory(JOINTS, START, [FAR], step=0.01)
    for before, now in pairwise(made.samples):
        gap = now.time - before.time
        for i in range(4):
            mean = (before.velocities[i] + now.velocities[i]) / 2
            assert (now.positions[i] - before.positions[i]) / gap == pytest.approx(mean, abs=1e-3)


def test_no_move_is_still_a_trajectory() -> None:
    made = trajectory(JOINTS, START, [START, START])
    assert [sample.positions for sample in made.samples] == [START, START]
    assert made.samples[1].time > made.samples[0].time
    assert made.progress(1.0) == (2, 100)


def test_a_joint_outside_its_limits_comes_back() -> None:
    sagged = (0, -0.05, 1.5, 0.5, 0)
    made = trajectory(JOINTS, sagged, [START])
    assert max(sample.positions[1] for sample in made.samples) == -0.05


def test_progress_counts_moves() -> None:
    made = trajectory(JOINTS, START, [NEAR, FAR])
    assert made.progress(0.0) == (1, 0)
    assert made.progress(made.stops[0] / 2) == (1, 50)
    assert made.progress(made.stops[0]) == (2, 0)
    assert made.progress(made.duration + 9) == (2, 100)


def test_a_wrong_profile_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    lax = {name: joint.model_copy(update={"velocity": joint.velocity * 1.2}) for name, joint in JOINTS.items()}
    profile = module._profile
    monkeypatch.setattr(module, "_profile", lambda limits, a, b: profile(tuple(lax.values()), a, b))
    with pytest.raises(SubtaskFailed, match=r"LIMITS_LEFT: swing_joint would leave its limits after \d"):
        trajectory(JOINTS, START, [(5.0, *START[1:])])


def test_a_limit_that_the_generator_cannot_use() -> None:
    broken = {name: joint.model_copy(update={"velocity": -1.0}) for name, joint in JOINTS.items()}
    with pytest.raises(SubtaskFailed, match="NO_TRAJECTORY: there is no trajectory inside the limits"):
        trajectory(broken, START, [FAR])
