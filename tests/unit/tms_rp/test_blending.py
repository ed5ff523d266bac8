"""Trajectories through poses keep every limit, lose no time at the corners, and stay near the poses."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_rp.blending import blended
from tms_rp.trajectory import STEP, Trajectory, trajectory

JOINTS = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel).joints
Pose = tuple[float, ...]
pose = st.tuples(
    st.floats(-7, 7), st.floats(-1.137, -0.1), st.floats(0.594, 2.687), st.floats(-0.622, 2.372), st.just(0.0)
)
START: Pose = (0.0, -0.5, 1.5, 0.5, 0.0)
LOW: Pose = (0.0, -0.2, 1.5, 0.5, 0.0)
NEAR: Pose = (0.0, -0.2, 2.3, 0.5, 0.0)
UP: Pose = (0.0, -0.9, 2.3, 1.6, 0.0)


def columns(made: Trajectory, what: str) -> np.ndarray:
    return np.array([getattr(sample, what) for sample in made.samples])


def beyond(made: Trajectory) -> list[str]:
    """Limits that are left, also by the differences between the samples: what they tell of themselves is not enough."""
    times, found = columns(made, "time"), list[str]()
    gaps = np.diff(times)[:, None]
    places, speeds, forces = (columns(made, what) for what in ("positions", "velocities", "accelerations"))
    for i, (name, joint) in enumerate(JOINTS.items()):
        low, high = joint.min or -math.inf, joint.max or math.inf
        checks = {
            "position": (places[:, i].min() >= low - 1e-6 and places[:, i].max() <= high + 1e-6),
            "velocity": max(np.abs(speeds[:, i]).max(), np.abs(np.diff(places, axis=0) / gaps)[:, i].max())
            <= joint.velocity * 1.0001,
            "acceleration": max(np.abs(forces[:, i]).max(), np.abs(np.diff(speeds, axis=0) / gaps)[:, i].max())
            <= joint.acceleration * 1.0001,
            "jerk": np.abs(np.diff(forces, axis=0) / gaps)[:, i].max() <= joint.jerk * 1.001,
        }
        found += [f"{name} {what}" for what, fine in checks.items() if not fine]
    return found


@given(pose, st.lists(st.tuples(pose, st.sampled_from([0.0, 0.0, 0.4, 3.0])), min_size=1, max_size=6))
def test_random_poses_keep_all_limits(start: Pose, rest: list[tuple[Pose, float]]) -> None:
    targets = [one for one, _ in rest]
    made = blended(JOINTS, [start, *targets], [least for _, least in rest])
    assert beyond(made) == []
    assert made.samples[0].positions == start and made.samples[-1].positions == pytest.approx(targets[-1], abs=1e-12)
    for sample in (made.samples[0], made.samples[-1]):
        assert set(sample.velocities) == set(sample.accelerations) == {0.0}
    gaps = [b.time - a.time for a, b in pairwise(made.samples)]
    assert min(gaps) > 0 and max(gaps) <= STEP + 1e-9
    assert list(made.stops) == sorted(made.stops)
    still = all(target == pytest.approx(start, abs=2e-9) for target in targets)
    assert made.stops[-1] == pytest.approx(made.duration) or still


def test_no_corner_is_a_stop_and_time_is_saved() -> None:
    poses = [START, LOW, NEAR, UP, (1.5, *UP[1:])]
    made = blended(JOINTS, poses, [0.0] * 4)
    times, speeds = columns(made, "time"), np.abs(columns(made, "velocities")).max(axis=1)
    assert speeds[(times > 0.5) & (times < made.duration - 0.5)].min() > 0.02
    assert made.duration < 0.75 * trajectory(JOINTS, poses[0], poses[1:]).duration


def test_one_line_takes_hardly_longer_than_the_fastest_motion() -> None:
    for target in (LOW, UP, (1.5, *START[1:]), (0.05, *START[1:])):
        fastest = trajectory(JOINTS, START, [target]).duration
        assert blended(JOINTS, [START, target], [0.0]).duration <= fastest + 0.6


def test_it_passes_near_each_pose_when_it_says_so() -> None:
    poses = [START, LOW, NEAR, UP]
    made = blended(JOINTS, poses, [0.0, 2.0, 2.0])
    for stop, target in zip(made.stops, poses[1:], strict=True):
        at = min(made.samples, key=lambda sample: abs(sample.time - stop))
        assert np.abs(np.subtract(at.positions, target)).max() < 0.12


def test_a_line_takes_as_long_as_it_is_told() -> None:
    quick, slow = (blended(JOINTS, [START, LOW, NEAR], [0.0, least]) for least in (0.0, 6.0))
    assert slow.stops[1] - slow.stops[0] >= 6.0 > quick.duration


def test_poses_that_are_equal_cost_nothing() -> None:
    assert (
        blended(JOINTS, [START, START, LOW, LOW], [0.0] * 3).duration == blended(JOINTS, [START, LOW], [0.0]).duration
    )
    still = blended(JOINTS, [START, START], [0.0])
    assert {sample.positions for sample in still.samples} == {START} and len(still.samples) == 2


def test_samples_are_derivatives_of_each_other() -> None:
    made = blended(JOINTS, [START, LOW, UP], [0.0, 0.0], step=0.01)
    gaps = np.diff(columns(made, "time"))[:, None]
    for what, of, off in (("positions", "velocities", 1e-3), ("velocities", "accelerations", 0.03)):
        means = (columns(made, of)[1:] + columns(made, of)[:-1]) / 2
        assert np.abs(np.diff(columns(made, what), axis=0) / gaps - means).max() < off


def test_each_joint_may_lag_by_a_time_of_its_own() -> None:
    made = blended(JOINTS, [START, UP], [0.0])
    late = made.lagging((0.0, 0.5, 0.0, 1.0, 0.0))
    assert late.duration == pytest.approx(made.duration + 1.0)
    assert late.samples[0].positions == START and late.samples[-1].positions == pytest.approx(UP)
    at = 20
    boom = np.interp(late.samples[at].time - 0.5, columns(made, "time"), columns(made, "positions")[:, 1])
    assert late.samples[at].positions[1] == pytest.approx(boom)
    assert late.samples[at].positions[2] == pytest.approx(made.samples[at].positions[2])
