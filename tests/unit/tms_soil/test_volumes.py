"""Cut and fill of bodies whose volume is known, and what unknown cells may add."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_soil.surface import Heights, Pit, Plane, grid, inside
from tms_soil.volumes import against, between

FLAT = grid((0.0, 0.0, 12.0, 10.0), 0.1)
GROUND = Heights(FLAT.x0, FLAT.y0, FLAT.cell, np.zeros(FLAT.z.shape))


def raised(by: np.ndarray) -> Heights:
    return Heights(GROUND.x0, GROUND.y0, GROUND.cell, GROUND.z + by)


def test_a_prism_is_exact() -> None:
    x, y = GROUND.centres
    dug = np.where((x > 2) & (x < 5) & (y > 1) & (y < 3), -1.5, 0.0) + np.where(x > 11, 0.25, 0.0)
    found = between(GROUND, raised(dug))
    assert found.cut == pytest.approx(3 * 2 * 1.5, rel=1e-12)
    assert found.fill == pytest.approx(1 * 10 * 0.25, rel=1e-12)
    assert found.net == pytest.approx(2.5 - 9.0, rel=1e-12)
    assert (found.area, found.unknown) == (pytest.approx(120.0), 0.0)
    assert (found.cut_at_most, found.fill_at_most) == (found.cut, found.fill)
    back = between(raised(dug), GROUND)
    assert (back.cut, back.fill) == (pytest.approx(found.fill), pytest.approx(found.cut))


def test_a_cone_comes_close_and_closer_with_smaller_cells() -> None:
    errors = []
    for cell in (0.4, 0.1):
        empty = grid((0.0, 0.0, 12.0, 10.0), cell)
        x, y = empty.centres
        cone = np.maximum(0.0, 2.0 - 0.5 * np.hypot(x - 6.03, y - 5.02))  # 4 m radius, 2 m high
        found = between(Heights(0.0, 0.0, cell, np.zeros(x.shape)), Heights(0.0, 0.0, cell, cone))
        errors.append(abs(found.fill / (math.pi * 16 * 2 / 3) - 1))
    assert errors[1] < 5e-4 and errors[1] < errors[0]


def test_a_pit_against_a_level_ground() -> None:
    pit = Pit(((4.0, 4.0), (8.0, 4.0), (8.0, 6.0), (4.0, 6.0)), level=-1.0, slope=1.0, rim=0.0)
    found = against(GROUND, pit)
    # Floor 4 x 2, four wedges of 1 m with a length of 12 m together, a cone of 1 m at the four corners.
    assert found.cut == pytest.approx(8 + 12 / 2 + math.pi / 3, rel=2e-3)
    assert (found.fill, found.unknown) == (0.0, 0.0)
    assert found.area < 40  # what the design says nothing about does not count
    wide = against(GROUND, pit, np.ones(GROUND.z.shape, dtype=bool))
    assert (wide.unknown, wide.cut) == (0.0, found.cut)
    deeper = against(raised(np.full(GROUND.z.shape, -2.0)), pit)
    assert deeper.cut == 0.0 and deeper.fill > 8


def test_only_the_mask_counts() -> None:
    x, y = GROUND.centres
    mask = inside(((1.0, 1.0), (3.0, 1.0), (3.0, 4.0), (1.0, 4.0)), x, y)
    assert against(GROUND, Plane(0.5), mask).fill == pytest.approx(2 * 3 * 0.5)
    assert between(GROUND, raised(np.full(GROUND.z.shape, -1.0)), mask).cut == pytest.approx(6.0)


def test_unknown_cells_widen_the_bounds_by_the_largest_change() -> None:
    z = np.full(GROUND.z.shape, -0.5)
    z[0, 0], z[0, 1] = -2.0, 0.3
    z[5, :10] = np.nan
    found = between(GROUND, raised(z))
    assert found.unknown == pytest.approx(0.1)  # ten cells of 0.01 m2
    assert found.cut_at_most - found.cut == pytest.approx(0.1 * 2.0)
    assert found.fill_at_most - found.fill == pytest.approx(0.1 * 0.3)
    nothing = between(GROUND, raised(np.full(z.shape, np.nan)))
    assert (nothing.cut, nothing.area, nothing.cut_at_most) == (0.0, 0.0, math.inf)


def test_grounds_that_overlap_in_part_are_unknown_where_only_one_is() -> None:
    other = Heights(6.0, 0.0, 0.2, np.full((50, 50), 1.0))  # x from 6 to 16 m
    found = between(GROUND, other)
    assert found.fill == pytest.approx(6 * 10)
    assert found.unknown == pytest.approx(4 * 10)


@given(st.integers(0, 2**32 - 1), st.floats(0.05, 2.0))
def test_net_is_the_change_of_the_mean(seed: int, cell: float) -> None:
    z = np.random.default_rng(seed).normal(size=(2, 7, 5))
    found = between(Heights(0.0, 0.0, cell, z[0]), Heights(0.0, 0.0, cell, z[1]))
    assert found.net == pytest.approx(float((z[1] - z[0]).mean()) * 35 * cell**2, abs=1e-9)
    assert found.cut >= 0 and found.fill >= 0
