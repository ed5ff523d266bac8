"""The arm keeps its limits whatever it is asked for, and needs time to stop."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tms_core.config import CONFIGS
from tms_core.models import MachineModel
from tms_core.yaml_file import parse
from tms_sim.arm import SUBSTEP, Arm
from tms_sim.path import Point

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
NAMES = tuple(MODEL.joints)
STEP = 0.02


def arm(seed: int = 0, noise: float = 0.0) -> Arm:
    return Arm(MODEL.joints, MODEL.initial, seed, noise)


def swing(angle: float, seconds: float) -> list[Point]:
    start = [MODEL.initial[name] for name in NAMES]
    return [Point(seconds, (angle, *start[1:]))]


def run(made: Arm, seconds: float, step: float = STEP) -> list[tuple[list[float], list[float]]]:
    seen = []
    for _ in range(round(seconds / step)):
        made.step(step)
        seen.append((list(made.positions), list(made.velocities)))
    return seen


def test_it_starts_at_rest_where_the_model_says() -> None:
    made = arm()
    assert dict(zip(NAMES, made.positions, strict=True)) == MODEL.initial
    assert made.still


def test_it_arrives() -> None:
    made = arm()
    made.follow(NAMES, swing(0.5, 4.0))
    run(made, 8.0)
    assert made.positions[0] == pytest.approx(0.5, abs=1e-3)


wild = st.tuples(*(st.floats(-6, 6) for _ in range(4)), st.just(0.0))


@settings(max_examples=40, deadline=None)
@given(st.lists(wild, min_size=1, max_size=3), st.floats(0.05, 3.0), st.integers(1, 80))
def test_it_keeps_its_limits_with_wild_goals(targets: list[tuple[float, ...]], gap: float, stop: int) -> None:
    made = arm()
    made.follow(NAMES, [Point(gap * (i + 1), target) for i, target in enumerate(targets)])
    before = list(made.velocities)
    for tick in range(200):
        if tick == stop:
            made.hold()
        made.step(SUBSTEP)  # one at a time: after an end stop the next one may leave it again
        for i, joint in enumerate(MODEL.joints.values()):
            ended = made.positions[i] in (joint.min, joint.max)  # an end stop stops at once
            assert abs(made.velocities[i]) <= joint.velocity + 1e-9
            assert ended or abs(made.velocities[i] - before[i]) <= joint.acceleration * SUBSTEP + 1e-9
            assert joint.violation(made.positions[i]) is None
        before = list(made.velocities)


def test_stopping_takes_the_time_that_braking_needs() -> None:
    made = arm()
    made.follow(NAMES, swing(2.5, 5.0))
    run(made, 2.0)
    speed, begun = made.velocities[0], made.positions[0]
    assert speed > 0.4
    made.hold()
    moving = [v for _, v in run(made, 4.0) if v[0] > 0]
    assert len(moving) * STEP == pytest.approx(speed / 0.35, abs=0.05)
    assert made.positions[0] - begun == pytest.approx(speed**2 / 0.7, abs=0.02)
    assert made.still


def test_the_motion_is_the_same_at_any_time_scale() -> None:
    slow, fast = arm(), arm()
    for made in (slow, fast):
        made.follow(NAMES, swing(0.5, 4.0))
    run(slow, 0.3, 0.02)
    run(fast, 0.3, 0.1)
    assert slow.velocities[0] > 0.05
    assert slow.positions == pytest.approx(fast.positions, abs=1e-6)


def test_noise_follows_the_seed() -> None:
    assert arm(1, 0.01).reading() == arm(1, 0.01).reading() != arm(2, 0.01).reading()
    quiet = arm()
    assert quiet.reading() == quiet.positions
