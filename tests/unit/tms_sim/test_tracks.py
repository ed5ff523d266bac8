"""Tracks answer speeds as a lag, and brake where they are told to stand."""

import math
from itertools import pairwise

import pytest

from tms_config.models import Drive, Response
from tms_sim.base import Base, Leg
from tms_sim.tracks import SUBSTEP

DRIVE = Drive(velocity=1.0, acceleration=0.5, turn_velocity=0.4, turn_acceleration=0.4)


def base(dead_time: float = 0.0, lag: float = 1.34) -> Base:
    return Base(DRIVE, (0.0, 0.0, 0.0), Response(dead_time=dead_time, lag=lag, origin="test"))


def run(made: Base, seconds: float) -> None:
    for _ in range(round(seconds / SUBSTEP)):
        made.step(SUBSTEP)


def test_a_speed_is_answered_as_a_lag() -> None:
    made = base()
    made.command(1.0, 0.2)
    run(made, 1.34)
    assert (made.v, made.w) == pytest.approx((1 - math.exp(-1), 0.2 * (1 - math.exp(-1))), abs=0.01)


def test_with_dead_time_it_comes_later_and_goes_later() -> None:
    made = base(dead_time=0.5)
    made.command(1.0, 0.0)
    run(made, 0.48)
    assert made.still is False and made.v == 0.0
    run(made, 5.0)
    made.command(0.0, 0.0)
    speed = made.v
    run(made, 0.48)
    assert made.v >= speed
    run(made, 1.0)
    assert made.still


def test_a_stop_that_is_repeated_all_the_time_lets_it_come_to_rest() -> None:
    """A gateway repeats zero every half a second until it has seen the machine stand."""
    made = base(dead_time=0.6)
    made.command(1.0, 0.0)
    run(made, 2.0)
    for _ in range(4):
        made.command(0.0, 0.0)
        run(made, 0.5)
    assert made.still


def test_zero_brakes_and_a_small_speed_does_not() -> None:
    braked, slowed = base(), base()
    for made, speed in ((braked, 0.0), (slowed, 0.01)):
        made.command(1.0, 0.3)
        run(made, 5.0)
        made.command(speed, 0.0)
        run(made, 1.0)
    assert braked.still
    assert slowed.v > 0.4


def test_the_emergency_stop_drops_what_is_under_way_where_it_acts_at_once() -> None:
    for immediately in (True, False):
        made = base(dead_time=1.0)
        made.command(1.0, 0.0)
        run(made, 0.5)
        made.halt(immediately)
        run(made, 0.9)
        assert (made.v > 0.1) is not immediately
        run(made, 2.0)
        assert made.still


def test_the_navigation_slows_down_without_the_brakes() -> None:
    for way in range(20):
        made, speeds = base(), [0.0]
        made.go([Leg(4 + way / 97, 0, 0.0)])
        while made.legs:
            made.step(SUBSTEP)
            speeds.append(made.v)
        assert min(b - a for a, b in pairwise(speeds)) >= -DRIVE.acceleration * SUBSTEP - 1e-4


@pytest.mark.parametrize("lag", [0.54, 1.34])
def test_the_navigation_arrives_in_spite_of_the_lag(lag: float) -> None:
    made, ideal = base(lag=lag), Base(DRIVE, (0.0, 0.0, 0.0))
    for one in (made, ideal):
        one.go([Leg(5, 2, None), Leg(9, -3, 1.0), Leg(9, 3, -2.0)])
        run(one, 90)
        assert not one.legs and one.still
        assert math.hypot(one.x - 9, one.y - 3) < 0.15
        assert abs(math.remainder(one.yaw + 2.0, math.tau)) < 0.03
    assert (made.x, made.y) == pytest.approx((ideal.x, ideal.y), abs=0.05)
