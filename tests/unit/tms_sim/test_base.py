"""Tracks reach a place from anywhere, keep their limits, and need time to stop."""

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_config.models import Drive
from tms_sim.base import ALIGNED, SUBSTEP, Base, Leg

DRIVE = Drive(velocity=1.0, acceleration=0.5, turn_velocity=0.35, turn_acceleration=0.35)
place = st.floats(-20, 20)
heading = st.floats(-math.pi, math.pi)


def run(base: Base, seconds: float, step: float = SUBSTEP) -> list[tuple[float, float]]:
    seen = []
    for _ in range(round(seconds / step)):
        base.step(step)
        seen.append((base.v, base.w))
    return seen


@given(place, place, heading, place, place, heading)
def test_it_arrives_from_anywhere_and_keeps_its_limits(
    x: float, y: float, yaw: float, tx: float, ty: float, tyaw: float
) -> None:
    base = Base(DRIVE, (x, y, yaw))
    base.go([Leg(tx, ty, tyaw)])
    seen = run(base, 150)
    assert not base.legs and base.still
    assert math.hypot(base.x - tx, base.y - ty) < 0.15
    assert abs(math.remainder(base.yaw - tyaw, math.tau)) < 2 * ALIGNED
    assert max(abs(v) for v, _ in seen) <= DRIVE.velocity + 1e-9
    assert max(abs(w) for _, w in seen) <= DRIVE.turn_velocity + 1e-9
    gains = [abs(b[0] - a[0]) for a, b in pairwise(seen)]
    assert max(gains) <= DRIVE.acceleration * SUBSTEP + 1e-9


def test_it_does_not_stop_at_poses_that_are_passed() -> None:
    base = Base(DRIVE, (0.0, 0.0, 0.0))
    base.go([Leg(5, 0, None), Leg(10, 0, None), Leg(15, 0, 0.0)])
    seen = run(base, 16)
    assert min(v for v, _ in seen[150:600]) == pytest.approx(1.0)


def test_hold_brakes_within_the_acceleration() -> None:
    base = Base(DRIVE, (0.0, 0.0, 0.0))
    base.go([Leg(50, 0, 0.0)])
    run(base, 5)
    begun = base.x
    base.hold()
    run(base, 1.9)
    assert not base.still
    run(base, 0.2)
    assert base.still and 0.9 < base.x - begun < 1.1


def test_velocity_commands_hold_until_the_next_and_are_cut() -> None:
    base = Base(DRIVE, (0.0, 0.0, 0.0))
    base.command(9.0, 0.1)
    run(base, 10)
    assert (base.v, base.w) == pytest.approx((1.0, 0.1))
    base.command(math.nan, 0.0)
    assert base.v == pytest.approx(1.0)
    base.command(0.0, 0.0)
    run(base, 3)
    assert base.still


def test_the_same_at_any_time_scale() -> None:
    ends = []
    for step in (0.04, 0.4):
        base = Base(DRIVE, (0.0, 0.0, 0.0))
        base.go([Leg(3, 4, 1.0)])
        run(base, 40, step)
        ends.append((base.x, base.y, base.yaw))
    assert ends[0] == pytest.approx(ends[1], abs=1e-9)


def test_a_limit_slows_ways_and_turns_by_the_same_share() -> None:
    base = Base(DRIVE, (0.0, 0.0, math.pi))
    base.limit(0.2)
    base.go([Leg(5, 0, 0.0)])
    seen = run(base, 90)
    assert not base.legs and max(v for v, _ in seen) == pytest.approx(0.2)
    assert max(abs(w) for _, w in seen) == pytest.approx(0.2 * DRIVE.turn_velocity, rel=0.02)
    base.limit(math.inf)
    base.go([Leg(15, 0, 0.0)])
    assert max(v for v, _ in run(base, 10)) == pytest.approx(DRIVE.velocity)
