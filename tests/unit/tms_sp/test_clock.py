"""A source's clock: offset, age, and stamps from the future."""

import pytest

from tms_sp.clock import WINDOW, SourceClock


def test_the_offset_is_the_shortest_way() -> None:
    clock = SourceClock(0.5)
    assert clock.offset is None
    assert clock.age(100.0, 103.2) == pytest.approx(0.0)
    assert clock.age(101.0, 104.0) == pytest.approx(0.0)
    assert clock.age(102.0, 105.7) == pytest.approx(0.7)
    assert clock.offset == pytest.approx(3.0)
    assert clock.off


def test_a_clock_that_was_set_is_right_again_after_two_windows() -> None:
    clock = SourceClock(0.5)
    clock.age(0.0, 3.0)
    for step in range(1, 30):
        now = 3.0 + step * WINDOW / 10
        clock.age(now - 0.01, now)
    assert clock.offset == pytest.approx(0.01)
    assert not clock.off


def test_after_our_clock_was_set_back_windows_go_on() -> None:
    clock = SourceClock(0.5)
    clock.age(3600.0, 3600.0)
    for step in range(30):
        now = step * WINDOW / 10
        clock.age(now - 0.3, now)
    assert clock.offset == pytest.approx(0.3)


def test_only_what_is_further_ahead_than_allowed_is_the_future() -> None:
    clock = SourceClock(0.5)
    assert clock.ahead(10.4, 10.0) == 0.0
    assert clock.ahead(11.0, 10.0) == pytest.approx(0.5)
