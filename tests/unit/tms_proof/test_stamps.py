"""Stamps on this PC's clock: the smallest delay of a while tells how far the clocks are apart."""

import pytest

from tms_proof.facts import Stamps
from tms_proof.reasons import ClockAhead, ClockBack, SimulatorClock, UtcClock
from tms_proof.stamps import AHEAD, BACK, Judged, StampClock, StampVerdict

NEW, REPEATED, NEW_CLOCK = StampVerdict.NEW, StampVerdict.REPEATED, StampVerdict.NEW_CLOCK


def judged(*samples: tuple[float, float], kind: Stamps = "utc") -> Judged:
    """What is thought of the last of these samples, each when it was received and its stamp."""
    clock = StampClock(kind)
    return [clock.judge(*sample) for sample in samples][-1]


def test_where_nothing_is_stamped_the_arrival_counts() -> None:
    assert judged((1.0, 0.0), (2.0, 0.0), kind="none") == Judged(NEW, 2.0)


def test_the_smallest_delay_counts() -> None:
    assert judged((100.0, 0.0), (101.0, 0.5), (102.0, 1.0)) == Judged(NEW, 101.0)
    assert judged((100.0, 0.0), (101.0, 1.25), (102.0, 2.0)) == Judged(NEW, 101.75)


def test_the_smallest_delay_is_kept_for_a_period_and_forgotten_after_the_next() -> None:
    later = (0.0, 0.0), (31.0, 30.0)
    assert judged(*later) == Judged(NEW, 30.0)
    assert judged(*later, (62.0, 61.0)) == Judged(NEW, 62.0)


@pytest.mark.parametrize("received", [3.0, 10.0])
def test_a_repeated_stamp_is_of_the_moment_that_it_was_of(received: float) -> None:
    assert judged((received, 3.0), (11.0, 3.0)) == Judged(REPEATED, received)


def test_a_stamp_a_little_ahead_is_believed_and_one_further_ahead_is_of_another_clock() -> None:
    assert judged((0.0, 0.0), (1.0, 1.0 + AHEAD)).verdict is NEW
    assert judged((0.0, 0.0), (1.0, 2.5)) == Judged(NEW_CLOCK, 1.0, ClockAhead(1.5, UtcClock()))


def test_a_stamp_a_little_back_is_out_of_order_and_one_further_back_is_of_another_clock() -> None:
    assert judged((4.0, 4.0), (5.0, 4.0 - BACK)).verdict is REPEATED
    back = judged((4.0, 4.0), (5.0, 3.0), kind="since_start")
    assert back == Judged(NEW_CLOCK, 5.0, ClockBack(SimulatorClock(), 1.0))
