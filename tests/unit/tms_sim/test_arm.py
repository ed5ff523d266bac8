"""The arm keeps its limits whatever it is asked for, and needs time to stop."""

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.reference_trajectory import Knot
from tms_sim.arm import SUBSTEP, Arm
from tms_sim.drive import JointDrive

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
NAMES = tuple(MODEL.joints)
STEP = 0.02


def arm() -> Arm:
    """Without dead time and lag."""
    return Arm(MODEL.joints, MODEL.initial, {})


def swing(angle: float, seconds: float) -> list[Knot]:
    start = [MODEL.initial[name] for name in NAMES]
    return [Knot(seconds, (angle, *start[1:]))]


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


@given(st.lists(wild, min_size=1, max_size=3), st.floats(0.05, 3.0), st.integers(1, 80))
def test_it_keeps_its_limits_with_wild_goals(targets: list[tuple[float, ...]], gap: float, stop: int) -> None:
    made = arm()
    made.follow(NAMES, [Knot(gap * (i + 1), target) for i, target in enumerate(targets)])
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
    for response in ({}, MODEL.response):
        slow, fast, odd = (Arm(MODEL.joints, MODEL.initial, response) for _ in range(3))
        for made, step in ((slow, 0.02), (fast, 0.3), (odd, 0.003)):
            made.follow(NAMES, swing(0.5, 4.0))
            run(made, 1.8, step)
        assert slow.velocities[0] > 0.05
        assert slow.positions == fast.positions == odd.positions


# Moves that each joint makes in work: way rad, velocity rad/s, acceleration rad/s^2.
MOVES = [
    ("zx200", "swing_joint", 1.57, 1.1, 0.35),
    ("zx200", "boom_joint", 0.6, 0.45, 0.7),
    ("zx200", "arm_joint", -1.2, 1.1, 2.9),
    ("zx200", "bucket_joint", -1.4, 1.1, 4.2),
    ("ic120", "vessel_pin_joint", -1.1, 0.15, 0.3),
]


def ramped(way: float, velocity: float, acceleration: float) -> list[tuple[float, float, float]]:
    """Times, ways and velocities of a move that speeds up, goes on, and brakes."""
    fastest = min(velocity, math.sqrt(abs(way) * acceleration))
    ramp, whole = fastest / acceleration, fastest / acceleration + abs(way) / fastest
    found = []
    for t in (whole * i / 100 for i in range(101)):
        rate = min(fastest, acceleration * t, acceleration * (whole - t))
        gone = fastest * (t - ramp / 2) if ramp < t < whole - ramp else rate**2 / acceleration / 2
        found.append((t, math.copysign(gone if t <= whole - ramp else abs(way) - gone, way), math.copysign(rate, way)))
    return found


def followed(
    name: str, joint: str, move: tuple[float, float, float], dead_time: float = 0.0, lag: float = 1.0
) -> tuple[float, float]:
    """Worst distance from the reference [rad], and when [s after its end] it was last more than 0.03 rad. Its
    controller takes the dead time for this much [s] more than it is, and the lag for this many times what it is."""
    model = parse(CONFIGS / "machines" / f"{name}.yaml", MachineModel)
    real, names = model.response[joint], list(model.joints)
    start = [model.initial.get(one, 0.0) for one in names]
    known = {"dead_time": max(0.0, real.dead_time + dead_time), "lag": real.lag * lag}
    i = names.index(joint)
    made = Arm(model.joints, model.initial, {**model.response, joint: real.model_copy(update=known)})
    made.servos[joint]._drive = JointDrive(model.joints[joint], real, start[i])
    points = []
    for t, gone, rate in ramped(*move):
        positions, velocities = list(start), [0.0] * len(names)
        positions[i], velocities[i] = start[i] + gone, rate
        points.append(Knot(t, tuple(positions), tuple(velocities)))
    path = made.follow(names, points)
    worst = settled = 0.0
    while made.elapsed < path.duration + 5:
        made.step(0.04)
        off = abs(path.joint(i, made.elapsed) - made.positions[i])
        worst = max(worst, off)
        if off > 0.03:
            settled = made.elapsed - path.duration
    return worst, settled


@pytest.mark.parametrize(("name", "joint", "way", "velocity", "acceleration"), MOVES, ids=[m[1] for m in MOVES])
def test_a_machine_with_dead_time_and_lag_follows(
    name: str, joint: str, way: float, velocity: float, acceleration: float
) -> None:
    worst, settled = followed(name, joint, (way, velocity, acceleration))
    assert worst <= 0.05 and settled <= 0.3


@pytest.mark.parametrize(("name", "joint", "way", "velocity", "acceleration"), MOVES, ids=[m[1] for m in MOVES])
def test_it_follows_a_machine_that_is_not_quite_as_known(
    name: str, joint: str, way: float, velocity: float, acceleration: float
) -> None:
    move = (way, velocity, acceleration)
    assert followed(name, joint, move, dead_time=0.05)[0] <= 0.10
    assert followed(name, joint, move, dead_time=-0.05)[0] <= 0.10
    assert followed(name, joint, move, lag=1.3)[0] <= 0.23
    assert followed(name, joint, move, lag=0.7)[0] <= 0.23


def test_a_motion_begins_after_the_longest_dead_time() -> None:
    made = Arm(MODEL.joints, MODEL.initial, MODEL.response)
    made.follow(NAMES, [Knot(2.0, (0.5, *(MODEL.initial[name] - 0.1 for name in NAMES[1:4]), 0.0))])
    run(made, 0.9)
    assert made.positions == [MODEL.initial[name] for name in NAMES]
    run(made, 0.2)
    assert all(velocity != 0 for velocity in made.velocities[:4])


def test_braking_takes_the_dead_time_and_the_ramp() -> None:
    made = Arm(MODEL.joints, MODEL.initial, MODEL.response)
    made.follow(NAMES, swing(2.5, 4.0))
    run(made, 3.0)
    speed = made.velocities[0]
    assert speed > 0.4
    made.hold()
    seen = run(made, 0.9)
    assert seen[-1][1][0] > speed - 0.05  # what is under way plays
    begun, slower = made.now, []
    while not made.stands:
        made.step(STEP)
        slower.append(made.velocities[0])
    assert made.now - begun == pytest.approx(seen[-1][1][0] / 0.35, abs=0.3)
    assert all(later < before + 0.02 for before, later in pairwise(slower))


@pytest.mark.parametrize("immediately", [True, False])
def test_the_emergency_stop_holds_what_was_measured_when_it_took_effect(immediately: bool) -> None:
    made = Arm(MODEL.joints, MODEL.initial, MODEL.response)
    made.follow(NAMES, swing(2.5, 4.0))
    run(made, 3.0)
    made.halt(immediately)
    begun = made.positions[0]
    run(made, 0.92)
    went = made.positions[0] - begun
    assert (went > 0.4) is not immediately
    run(made, 15.0)
    assert made.still
    assert made.positions[0] - begun == pytest.approx(0.0 if immediately else went, abs=0.02)


def test_a_passive_joint_is_never_moved() -> None:
    made = arm()
    made.follow(NAMES, [Knot(2.0, (*(MODEL.initial[name] for name in NAMES[:4]), 1.0))])
    run(made, 4.0)
    assert made.positions[4] == 0.0
