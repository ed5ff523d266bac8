"""A joint's drive answers late, as a lag, within its torque and its end stops."""

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_config.models import Joint, Response
from tms_sim.drive import TORQUE, JointDrive

JOINT = Joint(min=-1.0, max=1.0, velocity=1.0, acceleration=2.0, jerk=4.0)
H = 0.01


def drive(dead_time: float = 0.3, lag: float = 1.0, position: float = 0.0) -> JointDrive:
    return JointDrive(JOINT, Response(dead_time=dead_time, lag=lag, origin="test"), position)


def run(made: JointDrive, seconds: float, now: float = 0.0) -> list[float]:
    seen = []
    for tick in range(1, round(seconds / H) + 1):
        made.step(now + tick * H, H)
        seen.append(made.position)
    return seen


def test_a_step_is_answered_after_the_dead_time_with_the_lag() -> None:
    made = drive()
    made.send(0.5, 0.0)
    seen = run(made, 9.0)
    assert seen[28] == 0.0 < seen[30]
    assert made.position == pytest.approx(0.5, abs=1e-3) and made.still
    reached = next(i for i, position in enumerate(seen) if position > 0.5 * (1 - math.exp(-1))) * H
    assert reached == pytest.approx(0.3 + 1.0, abs=0.15)  # the torque takes a little more


def test_commands_play_one_after_the_other() -> None:
    made = drive(lag=0.1)
    for tick in range(10):
        made.send(0.05 * tick, tick * 0.1)
    seen = run(made, 2.0)
    assert all(a <= b + 1e-6 for a, b in pairwise(seen))
    assert made.position == pytest.approx(0.45, abs=1e-3)


def test_more_dead_time() -> None:
    made = drive()
    made.send(0.5, 0.0, more=0.5)
    assert run(made, 0.79)[-1] == 0.0
    run(made, 0.1, 0.79)
    assert made.position > 0.0


@given(st.lists(st.floats(-5, 5), min_size=1, max_size=30), st.floats(0.0, 0.9), st.floats(0.2, 5.0))
def test_it_keeps_its_end_stops_and_its_torque(angles: list[float], dead_time: float, lag: float) -> None:
    made = drive(dead_time, lag)
    before = 0.0
    for tick in range(300):
        if tick % 10 == 0 and tick // 10 < len(angles):
            made.send(angles[tick // 10], tick * H)
        made.step((tick + 1) * H, H)
        assert -1.0 <= made.position <= 1.0
        if abs(made.position) < 1.0:
            assert abs(made.velocity - before) <= TORQUE * JOINT.acceleration * H + 1e-9
        before = made.velocity


@pytest.mark.parametrize(("immediately", "stops"), [(True, 0.0), (False, 0.3)])
def test_the_emergency_stop(immediately: bool, stops: float) -> None:
    made = drive()
    made.send(0.9, 0.0)
    run(made, 0.8)
    held = made.position
    made.halt(0.8, immediately)
    if not immediately:
        held = run(made, stops, 0.8)[-1]
    run(made, 8.0, 0.8 + stops)
    assert made.position == pytest.approx(held, abs=0.01) and made.still


def test_at_once_drops_what_is_under_way() -> None:
    made = drive()
    made.send(0.9, 0.0)
    made.halt(0.1, immediately=True)
    assert run(made, 2.0)[-1] == 0.0 and made.still


def test_it_is_not_slow_while_something_is_under_way() -> None:
    made = drive()
    assert made.slower(0.01)
    made.send(0.5, 0.0)
    assert made.velocity == 0.0 and not made.slower(0.01)
