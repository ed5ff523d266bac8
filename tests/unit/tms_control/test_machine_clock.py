"""The time of a simulator, from the stamps of messages that come late now and then."""

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_control.machine_clock import GAP, RUNS_ON, MachineClock

PERIOD = 0.04  # s of the simulator
LATEST = 0.03  # s that a message takes at most


def heard(rate: float, seed: int = 1, seconds: float = 4.0, begun: float = 0.0) -> tuple[MachineClock, float]:
    """A clock that has heard of a simulator for some time, and our time then."""
    clock, late = MachineClock(), random.Random(seed)
    for number in range(round(seconds * rate / PERIOD)):
        stamp = begun + number * PERIOD
        arrived = 100.0 + number * PERIOD / rate + late.uniform(0.0, LATEST)
        assert clock.hear(arrived, stamp)
    return clock, arrived


@given(rate=st.floats(0.3, 3.0), seed=st.integers(0, 1000))
def test_it_goes_as_fast_as_the_simulator(rate: float, seed: int) -> None:
    clock, now = heard(rate, seed)
    assert clock.rate == pytest.approx(rate, rel=0.06)
    true = (now - 100.0) * rate
    assert clock.now(now) == pytest.approx(true - LATEST / 2 * rate, abs=LATEST * rate)


def test_it_never_goes_behind_the_last_stamp() -> None:
    clock, now = heard(1.0)
    assert clock.stamp is not None
    assert clock.now(now - 1.0) == clock.stamp


def test_without_messages_it_stands_still_soon() -> None:
    clock, now = heard(1.0)
    assert clock.now(now + 60.0) == clock.now(now + RUNS_ON)
    assert clock.silent(now + 60.0) == pytest.approx(60.0)


def test_the_first_messages_count_as_fast_as_ours() -> None:
    clock = MachineClock()
    assert clock.now(5.0) is None and clock.stamp is None
    assert clock.hear(5.0, 0.0)
    assert clock.now(5.1) == pytest.approx(0.1)


def test_a_message_that_came_twice_changes_nothing() -> None:
    clock, now = heard(1.0)
    assert clock.stamp is not None
    before = clock.now(now + 0.01)
    assert clock.hear(now + 0.01, clock.stamp)
    assert clock.now(now + 0.01) == before


@pytest.mark.parametrize(("stamp", "goes_on"), [(0.0, False), (10.0, True)])
def test_after_a_restart_or_a_gap_the_line_begins_anew(stamp: float, goes_on: bool) -> None:
    clock, now = heard(0.5)
    assert clock.hear(now + GAP * 1.1, stamp) is goes_on
    assert clock.rate == 1.0 and clock.now(now + GAP * 1.1) == stamp
