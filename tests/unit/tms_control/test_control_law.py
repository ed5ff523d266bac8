"""The control law against a plant of its own: dq/dt = (u(t - D) - q) / tau, integrated exactly."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_control.control_law import MARGIN, ControlLaw

TURN = 0.04  # s


def played(sent: list[tuple[float, float]], begun: float, dead_time: float, lag: float, end: float) -> float:
    """Where a joint is at `end` that was sent these angles [s, rad]."""
    position, step = begun, 1e-3
    for tick in range(round(end / step)):
        effective = [angle for time, angle in sent if time + dead_time <= tick * step + 1e-9]
        if effective:
            position = effective[-1] + (position - effective[-1]) * math.exp(-step / lag)
    return position


@given(
    dead_time=st.floats(0.0, 1.0), lag=st.floats(0.3, 5.0),
    references=st.lists(st.tuples(st.floats(-1, 1), st.floats(-0.5, 0.5)), min_size=1, max_size=40),
)  # fmt: skip
def test_it_predicts_what_the_commands_under_way_will_do(
    dead_time: float, lag: float, references: list[tuple[float, float]]
) -> None:
    law, sent = ControlLaw(dead_time, lag, velocity=1.0), list[tuple[float, float]]()
    for tick, (position, velocity) in enumerate(references):
        now = tick * TURN
        measured = played(sent, 0.2, dead_time, lag, now)
        sent.append((now, law.command(now, measured, position, velocity)))
    now = len(references) * TURN
    predicted = law.predicted(now, played(sent, 0.2, dead_time, lag, now))
    assert predicted == pytest.approx(played(sent, 0.2, dead_time, lag, now + dead_time), abs=5e-3)


def test_without_a_command_the_joint_stays() -> None:
    law = ControlLaw(0.5, 1.0, velocity=1.0)
    assert law.predicted(3.0, 0.7) == 0.7
    assert law.predicted_velocity(3.0, 0.7) == 0.0


def test_the_angle_leads_by_the_lag_and_takes_back_what_is_missing() -> None:
    law = ControlLaw(0.0, 2.0, velocity=1.0)
    assert law.command(0.0, 0.5, 0.6, 0.3) == pytest.approx(0.5 + 2.0 * (0.3 + 0.1))


@pytest.mark.parametrize("way", [9.0, -9.0])
def test_it_asks_for_no_more_speed_than_the_joint_may_have(way: float) -> None:
    law = ControlLaw(0.0, 2.0, velocity=0.4)
    assert law.command(0.0, 0.0, way, 0.0) == pytest.approx(math.copysign(2.0 * MARGIN * 0.4, way))


def test_after_a_rest_nothing_is_under_way() -> None:
    law = ControlLaw(0.5, 1.0, velocity=1.0)
    law.command(0.0, 0.0, 1.0, 0.0)
    assert law.predicted(0.1, 0.0) > 0.0
    law.rest()
    assert law.predicted(0.1, 0.0) == 0.0
