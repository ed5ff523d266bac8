"""Orientations: the formulas agree with each other."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_machine.geometry import about, is_orientation, length, product, unit, x_axis, yaw_of

ANGLE = st.floats(-math.pi, math.pi)


@given(ANGLE, st.floats(0.1, 10.0))
def test_a_heading_comes_back_whatever_the_length(yaw: float, size: float) -> None:
    x, y, z, w = about("z", yaw)
    assert math.cos(yaw_of((size * x, size * y, size * z, size * w)) - yaw) == pytest.approx(1)


@given(ANGLE, ANGLE)
def test_one_turn_after_another(yaw: float, pitch: float) -> None:
    both = product(about("z", yaw), about("y", pitch))
    assert length(both) == pytest.approx(1)
    wanted = (math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), -math.sin(pitch))
    assert x_axis(both) == pytest.approx(wanted, abs=1e-9)


def test_what_people_type_is_an_orientation_and_is_brought_to_the_length_1() -> None:
    assert is_orientation((0.0, 0.0, 0.7, 0.7)) and is_orientation((0.0, 0.0, 0.707, 0.707))
    assert not is_orientation((0.0, 0.0, 0.5, 0.5)) and not is_orientation((0.0, 0.0, 0.0, 0.0))
    assert length(unit((0.0, 0.0, 0.7, 0.7))) == pytest.approx(1)
    assert yaw_of((0.0, 0.0, 0.0, 0.0)) == 0.0
