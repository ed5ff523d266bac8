"""One quantity: what shows a motion, when it has stood for long enough, and which limits count as standing."""

from collections.abc import Iterable

import pytest

from tms_proof.channel import BETWEEN, JITTER, KEPT, WORST, Channel, Limits, distance

LIMIT = 0.25  # rad/s
ALWAYS = float("-inf")


def told(limits: Limits, samples: Iterable[tuple[float, float | None, float | None]], ahead: float = 0.0) -> Channel:
    """A channel with samples of time [s], angle [rad; None: only a speed is told] and speed; stamps are `ahead`."""
    channel = Channel(limits)
    for at, angle, speed in samples:
        channel.add(at, at + ahead, () if angle is None else (angle,), speed)
    return channel


def stamped(samples: Iterable[tuple[float, float, float]]) -> Channel:
    """A channel with samples of reception [s], measurement [s] and angle [rad]."""
    channel = Channel(Limits(LIMIT))
    for received, measured, angle in samples:
        channel.add(received, measured, (angle,), None)
    return channel


def test_a_speed_at_the_limit_is_a_motion() -> None:
    assert told(Limits(LIMIT), [(0.0, None, LIMIT), (0.125, None, LIMIT)]).moving()
    assert not told(Limits(LIMIT), [(0.0, None, 0.24), (0.125, None, -0.24)]).moving()


def test_a_speed_counts_for_a_while_and_not_longer() -> None:
    times = (0.0, WORST / 2, WORST)
    assert told(Limits(LIMIT), [(at, None, 0.0 if at else 1.0) for at in times]).moving()
    assert not told(Limits(LIMIT), [(at, None, 0.0 if at else 1.0) for at in (*times, WORST + 0.1)]).moving()


def test_two_samples_are_needed_and_enough() -> None:
    assert told(Limits(LIMIT), [(0.0, 0.0, 0.0)]).moving()
    assert not told(Limits(LIMIT), [(0.0, 0.0, 0.0), (0.125, 0.0, 0.0)]).moving()


def test_positions_show_a_motion_above_the_limit_only() -> None:
    at_limit = [(0.0, 0.0, None), (0.125, LIMIT * 0.125, None), (0.25, LIMIT * 0.25, None)]
    assert not told(Limits(LIMIT), at_limit).moving()
    assert told(Limits(LIMIT), [(100.0, 0.0, None), (100.1, 0.1, None), (100.2, 0.1, None)]).moving()


def test_jitter_is_no_motion() -> None:
    jitter = [(0.1 * i, 0.015 * (i % 2), None) for i in range(4)]
    assert not told(Limits(LIMIT, resolution=0.02), jitter).moving()
    assert told(Limits(0.01, resolution=0.0), jitter).moving()


@pytest.mark.parametrize(("begins", "ends"), [(0, 1), (2, 3), (0, 3)])
def test_a_creep_that_jitter_hides_from_one_sample_to_the_next_shows_within_the_last_moments(
    begins: int, ends: int
) -> None:
    """The jitter is 0.02 rad; at the limit, the joint goes 0.025 rad from one sample to the next."""
    creeps = [(0.0, 0.0, None), (0.1, 0.035, None), (0.2, 0.06, None), (0.3, 0.0965, None)]
    assert told(Limits(LIMIT, resolution=0.02), creeps).moving()
    part = creeps[begins : ends + 1]
    assert told(Limits(LIMIT, resolution=0.02), part).moving() == (len(part) == 4)


@pytest.mark.parametrize(
    ("received", "measured"), [(1.0, 0.1), (0.1, 1.0)], ids=["measured at once", "received at once"]
)
def test_the_shorter_time_between_two_samples_counts(received: float, measured: float) -> None:
    """0.1 rad in a second is below the limit, in a tenth of it above."""
    samples = [(5.0, 5.0, 0.0), (5.0 + received, 5.0 + measured, 0.1), (5.1 + received, 5.1 + measured, 0.1)]
    assert stamped(samples).moving()


def test_a_stand_in_four_times_as_fast_moves_four_times_as_far_while_it_stands() -> None:
    slow = [(0.05 * i, 0.05 * 0.5 * i, None) for i in range(6)]  # 0.125 rad/s of its own time
    assert not told(Limits(LIMIT, scale=4.0), slow).moving()
    assert told(Limits(LIMIT), slow).moving()


def test_an_angle_that_turns_has_not_moved_when_it_wraps() -> None:
    wraps = [(0.0, 3.141, None), (0.1, -3.141, None), (0.2, 3.141, None)]
    assert not told(Limits(LIMIT, turns=True), wraps).moving()
    assert told(Limits(LIMIT), wraps).moving()


def test_distances_are_straight_and_those_of_turning_angles_the_shorter_way() -> None:
    assert distance((0.0, 0.0), (3.0, 4.0)) == 5.0
    assert distance((0.0,), (7.0,)) == 7.0
    assert distance((3.0,), (-3.0,), turns=True) == pytest.approx(0.2831853)


# for how long it has stood


def test_standing_counts_once_it_has_lasted_for_as_long_as_was_asked() -> None:
    stands = told(Limits(LIMIT), [(0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (1.0, 0.0, 0.0), (KEPT, 0.0, 0.0)])
    assert stands.stood_since(ALWAYS, KEPT)
    assert not stands.stood_since(ALWAYS, KEPT + 0.01)
    assert told(Limits(LIMIT), [(0.0, 0.0, 0.0), (0.25, 0.0, 0.0)]).stood_since(ALWAYS, 0.25)


def test_standing_begins_with_the_first_sample_after_a_motion() -> None:
    stopped = told(Limits(LIMIT), [(0.0, 0.0, 0.0), *((0.25 * i, 0.0, 1.0 if i == 1 else 0.0) for i in range(1, 5))])
    assert stopped.stood_since(ALWAYS, 0.5)
    assert not stopped.stood_since(ALWAYS, 0.51)


def test_what_moves_has_not_stood() -> None:
    assert not told(Limits(LIMIT), [(0.25 * i, 0.0, 1.0 if i == 4 else 0.0) for i in range(5)]).stood_since(ALWAYS, 0.1)


@pytest.mark.parametrize("late", [-0.5, 0.5], ids=["measured before", "stamped ahead, and received before"])
def test_only_what_was_measured_and_received_after_the_stop_counts(late: float) -> None:
    stands = told(Limits(LIMIT), [(0.125 * i, 0.0, 0.0) for i in range(9)], ahead=late)
    assert not stands.stood_since(0.5 + abs(late) / 2, 0.5)
    assert stands.stood_since(-0.5, 0.5)


@pytest.mark.parametrize(("received", "measured"), [(1.0, 1.0625), (1.0625, 1.0)])
def test_a_sample_at_the_moment_of_the_stop_is_not_after_it(received: float, measured: float) -> None:
    stands = stamped([(received, measured, 0.0), (1.25, 1.25, 0.0)])
    assert not stands.stood_since(1.0, 0.125)
    assert stands.stood_since(0.99, 0.125)


@pytest.mark.parametrize(("received", "measured"), [(1.125, 1.25), (1.25, 1.125)])
def test_samples_must_be_measured_and_received_over_the_whole_time(received: float, measured: float) -> None:
    stands = stamped([(1.0, 1.0, 0.0), (received, measured, 0.0)])
    assert stands.stood_since(ALWAYS, 0.125)
    assert not stands.stood_since(ALWAYS, 0.25)


@pytest.mark.parametrize(("more", "evident"), [(1e-6, True), (-1e-6, False)])
def test_a_motion_is_evident_once_a_jump_back_to_its_begin_would_be_noticed(more: float, evident: bool) -> None:
    speed, scale, resolution = 0.5, 2.0, 0.001
    way = resolution + BETWEEN + JITTER * scale * speed + more
    limits = Limits(LIMIT, resolution=resolution, scale=scale)
    began = [(0.0, 0.0, 0.0), (0.1, 0.0, 0.0)]
    assert told(limits, [*began, (0.2, way / 2, speed), (0.3, way, -speed)]).evident is evident
    assert told(limits, [*began, (0.2, way, speed), (0.3, way, 0.0)]).evident is False, "it is over"
    assert told(limits, [(0.0, 0.0, speed), (0.1, way, speed)]).evident is evident, "it began before"


def test_what_tells_no_place_shows_no_evident_motion() -> None:
    assert not told(Limits(LIMIT), []).evident
    assert not told(Limits(LIMIT), [(0.0, None, 0.0), (0.1, None, 2.0)]).evident
