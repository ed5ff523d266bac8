"""Positions and velocities that contradict each other, and places that no motion leads to."""

from collections.abc import Iterable

import pytest

from tms_proof.channel import BETWEEN, SPAN, SPEED_MARGIN, WORST, Channel, Limits, Place
from tms_proof.reasons import PositionsMove, VelocitiesMove

LIMIT = 0.25  # rad/s
LONG = SPAN * WORST  # s that samples must span

PLAIN = Limits(LIMIT)
STAND_IN = Limits(LIMIT, scale=4.0)


def told(
    limits: Limits, samples: Iterable[tuple[float, float | None, float | None]], stamp: float | None = None
) -> Channel:
    """A channel with samples of time [s], angle [rad; None: only a speed is told] and speed."""
    channel = Channel(limits)
    for at, angle, speed in samples:
        channel.add(at, at if stamp is None else stamp, () if angle is None else (angle,), speed)
    return channel


def steadily(
    speed: float, reported: float, period: float = 0.125, scale: float = 1.0
) -> list[tuple[float, float, float]]:
    """A quarter of a second at a speed."""
    return [(period * i, speed * scale * period * i, reported) for i in range(round(0.25 / period) + 1)]


def test_a_motion_that_the_velocities_deny_is_told() -> None:
    assert told(PLAIN, steadily(1.0, 0.0)).disagreement() == PositionsMove()
    assert told(PLAIN, steadily(1.0, 1.0)).disagreement() is None
    assert told(PLAIN, [(0.0, 0.0, 0.0), (LONG, 0.5, 0.0)]).disagreement() == PositionsMove()


def test_a_moment_is_too_short_to_compare_anything() -> None:
    assert told(PLAIN, [(100.0, 0.0, 0.0), (100.125, 0.5, 0.0)]).disagreement() is None


@pytest.mark.parametrize("moves", [1, 2, 3])
def test_a_motion_between_any_two_samples_is_compared(moves: int) -> None:
    assert told(PLAIN, [(0.1 * i, 0.5 * (i >= moves), 0.0) for i in range(4)]).disagreement() == PositionsMove()


def test_near_the_limits_positions_and_velocities_may_disagree() -> None:
    assert told(PLAIN, steadily(2 * LIMIT, 0.0)).disagreement() is None
    assert told(PLAIN, steadily(1.0, LIMIT)).disagreement() is None
    assert told(PLAIN, steadily(0.0, 2 * LIMIT)).disagreement() is None
    assert told(PLAIN, steadily(LIMIT, 1.0)).disagreement() is None
    assert told(PLAIN, steadily(0.4, 0.6)).disagreement() is None


def test_velocities_of_a_joint_that_stands_are_told() -> None:
    assert told(PLAIN, steadily(0.0, 0.6)).disagreement() == VelocitiesMove()
    assert told(PLAIN, steadily(0.2, 0.6)).disagreement() == VelocitiesMove()


def test_jitter_contradicts_no_velocity_of_zero() -> None:
    jitter = [(0.1 * i, 0.1 * (i % 2), 0.0) for i in range(4)]
    assert told(Limits(LIMIT, resolution=0.1), jitter).disagreement() is None
    assert told(PLAIN, [(0.1 * i, 0.2 * (i % 2), 0.0) for i in range(4)]).disagreement() == PositionsMove()


def test_a_speed_without_a_position_contradicts_nothing() -> None:
    assert told(PLAIN, [(0.125 * i, None, 1.0) for i in range(3)]).disagreement() is None


def test_samples_of_one_moment_contradict_nothing() -> None:
    assert told(PLAIN, steadily(1.0, 0.0), stamp=5.0).disagreement() is None


def test_the_speed_of_a_stand_in_is_that_of_its_own_time() -> None:
    assert told(STAND_IN, steadily(0.125, 0.0, 0.0625, 4.0)).disagreement() is None
    assert told(STAND_IN, steadily(1.0, 0.0, 0.0625, 4.0)).disagreement() == PositionsMove()


def test_between_samples_that_are_far_apart_a_whole_motion_may_be_hidden() -> None:
    assert told(STAND_IN, steadily(1.0, 0.0, 0.125, 4.0)).disagreement() is None
    assert told(PLAIN, [(0.0, 0.0, 0.0), (0.25, 0.5, 0.0)]).disagreement() == PositionsMove()
    assert told(PLAIN, [(0.0, 0.0, 0.0), (0.26, 0.5, 0.0)]).disagreement() is None


# places that no motion leads to


def leaps(
    limits: Limits, seconds: float, places: tuple[Place, Place], speeds: tuple[float | None, float | None]
) -> bool:
    """Whether the second place surprises."""
    channel = Channel(limits)
    channel.add(0.0, 0.0, places[0], speeds[0])
    channel.add(seconds, seconds, places[1], speeds[1])
    return channel.surprised == seconds


NO_SPEED, AT_REST = (None, None), (0.0, 0.0)


def test_no_joint_goes_faster_than_its_top_speed_and_a_margin() -> None:
    furthest = SPEED_MARGIN * 1.0 * 0.125 + BETWEEN
    assert not leaps(Limits(LIMIT, top=1.0), 0.125, ((0.0,), (furthest,)), NO_SPEED)
    assert leaps(Limits(LIMIT, top=1.0), 0.125, ((0.0,), (furthest + 0.001,)), NO_SPEED)
    assert not leaps(Limits(LIMIT, top=1.0, scale=4.0), 0.25, ((0.0,), (0.9,)), NO_SPEED)


def test_a_joint_at_rest_stays_where_it_is() -> None:
    for way in (-BETWEEN, BETWEEN):
        assert not leaps(PLAIN, 0.1, ((0.0,), (way,)), AT_REST)
        assert leaps(PLAIN, 0.1, ((0.0,), (2.5 * way,)), AT_REST)


def test_a_joint_goes_as_far_as_its_velocities_say() -> None:
    assert not leaps(PLAIN, 0.1, ((0.0,), (0.1,)), (1.0, 1.0))
    assert leaps(PLAIN, 0.1, ((0.0,), (0.5,)), (1.0, 1.0))
    assert leaps(PLAIN, 0.1, ((0.0,), (0.0,)), (1.0, 1.0))


def test_velocities_are_compared_with_the_way_up_to_a_pause() -> None:
    far = (0.0,), (0.5,)
    assert leaps(PLAIN, WORST / 2, far, AT_REST)
    assert not leaps(PLAIN, WORST, far, AT_REST)
    assert leaps(STAND_IN, 0.05, far, AT_REST)


def test_what_goes_on_elsewhere_after_a_gap_may_be_a_record() -> None:
    near, far, gaps = ((0.0,), (BETWEEN,)), ((0.0,), (0.02,)), Limits(LIMIT, longest=0.25)
    assert not leaps(gaps, 0.25, far, NO_SPEED)
    assert leaps(gaps, 0.26, far, NO_SPEED) and leaps(gaps, 0.26, far, (0.1, 0.1))
    assert not leaps(gaps, 0.26, near, NO_SPEED)


def test_a_stand_in_measures_as_much_earlier_as_it_is_faster() -> None:
    """Four times as fast, it goes 0.2 rad in 0.05 s, and what is stamped 0.025 s late may be 0.1 rad off."""
    assert not leaps(STAND_IN, 0.05, ((0.0,), (0.29,)), (1.0, 1.0))
    assert leaps(STAND_IN, 0.05, ((0.0,), (0.32,)), (1.0, 1.0))


def test_a_joint_goes_where_its_velocity_points() -> None:
    assert leaps(PLAIN, 0.1, ((0.0,), (-0.1,)), (1.0, 1.0))


def test_a_base_drives_into_any_direction() -> None:
    assert not leaps(PLAIN, 0.1, ((0.0, 0.0), (-0.1, 0.0)), (1.0, 1.0))
    assert leaps(PLAIN, 0.1, ((0.0, 0.0), (0.0, 0.5)), (1.0, 1.0))


def test_only_a_joint_that_turns_may_wrap() -> None:
    assert not leaps(Limits(LIMIT, turns=True), 0.1, ((3.1,), (-3.1,)), (0.8, 0.8))
    assert leaps(PLAIN, 0.1, ((3.1415926535,), (-3.1415926535,)), AT_REST)
