"""Tiles, windows and heights."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from earth_rig import flat, soils
from tms_soil.grid import BANK, COARSE, LOOSE, TILE, Grid
from tms_soil.surface import Heights


def hilly(side: float, cell: float = COARSE) -> Heights:
    level = flat(side, cell=cell)
    x, y = level.centres
    return Heights(level.x0, level.y0, cell, 3.7 + 0.2 * x - 0.1 * y)


def test_heights_come_back() -> None:
    given_ = hilly(20.0)
    grid = Grid.from_heights(given_, soils())
    found = grid.heights((-10, -10, 10, 10))
    assert (found.x0, found.y0, found.cell) == (given_.x0, given_.y0, given_.cell)
    assert found.z == pytest.approx(given_.z)
    rest = grid.heights().z
    assert rest.shape == (128, 128) and np.isnan(rest).sum() == 128 * 128 - 100 * 100, "beyond the file it is unknown"


def test_a_coarse_file_is_followed_between_its_cells() -> None:
    x, y = np.array([-3.1, 0.3, 7.9]), np.array([2.2, -6.4, 0.05])
    grid = Grid.from_heights(hilly(24.0, cell=1.0), soils())
    assert grid.sample(x, y) == pytest.approx(3.7 + 0.2 * x - 0.1 * y, abs=COARSE * 0.15 + 1e-9)


@settings(max_examples=15, deadline=None)
@given(st.tuples(*[st.floats(-14, 14)] * 4))
def test_a_window_that_is_stored_unchanged_changes_nothing(corners: tuple[float, float, float, float]) -> None:
    x0, x1, y0, y1 = *sorted(corners[:2]), *sorted(corners[2:])
    grid = Grid.from_heights(hilly(25.6), soils("earth", "sand"), np.array([[0, 1], [1, 0]], dtype=np.uint8))
    before, mass = grid.heights().z, grid.mass()
    window = grid.window((x0, y0, x1, y1))
    if window is not None:
        grid.store(window)
    assert grid.mass() == pytest.approx(mass, rel=1e-14)
    assert grid.heights().z == pytest.approx(before, nan_ok=True)


def test_what_a_window_changes_is_found_in_all_its_tiles() -> None:
    grid = Grid.from_heights(flat(2 * TILE), soils())
    mass = grid.mass()
    window = grid.window((-1.0, -1.0, 1.0, 1.0))
    assert window is not None and window.layers.shape == (3, 20, 20) and len(window.pieces) == 4
    window.layers[LOOSE] += soils()[0].loose
    grid.store(window)
    assert grid.mass() - mass == pytest.approx(4 * soils()[0].loose)
    assert grid.sample(np.array([-0.95, 0.95, 1.05]), np.array([-0.95, 0.95, 0.0])) == pytest.approx([1.0, 1.0, 0.0])
    assert grid.heights((-1, -1, 1, 1)).z == pytest.approx(np.ones((10, 10)))


def test_each_tile_has_the_densities_of_its_soil() -> None:
    kinds = soils("earth", "clay")
    grid = Grid.from_heights(flat(2 * TILE, z=2.0), kinds, np.array([[0, 1], [0, 0]], dtype=np.uint8))
    window = grid.window((-0.1, -0.1, 0.1, 0.1))
    assert window is not None
    window.layers[BANK] += 100.0
    thick = 100 / kinds[0].bank, 100 / kinds[1].bank
    assert window.heights() == pytest.approx(np.array([[thick[0], thick[1]], [thick[0], thick[0]]]) + 2.0)


def test_nothing_exceeds_the_top_that_it_tells() -> None:
    grid = Grid.from_heights(hilly(25.6), soils())
    told = grid.top((10.0, -10.0, 12.7, -9.0))
    window = grid.window((0.0, -12.8, 12.8, 0.0))
    assert window is not None
    assert window.heights().max() <= told < window.heights().max() + 0.01
    window.layers[LOOSE][5, 5] = 5000.0
    grid.store(window)
    assert grid.top((1.0, -12.0, 1.1, -11.0)) > told + 1.0


@pytest.mark.parametrize("at", [(7.0, 7.0), (7.0, 0.0), (800.0, 0.0), (0.0, -800.0), (-800.0, 800.0)])
def test_outside_the_site_there_is_nothing(at: tuple[float, float]) -> None:
    grid = Grid.from_heights(flat(), soils())
    there = (*at, at[0] + 1.0, at[1] + 1.0)
    assert grid.window(there) is None
    assert grid.top(there) == -math.inf


def test_outside_the_site_no_height_is_known() -> None:
    grid = Grid.from_heights(flat(), soils())
    assert np.isnan(grid.sample(np.array([7.0, -6.5]), np.array([0.0, 0.0]))).all()


def test_a_site_of_200_m_by_200_m_takes_less_than_150_mb() -> None:
    grid = Grid.from_heights(flat(200.0), soils())
    assert grid.bytes < 30e6, "nobody works there yet"
    x0, y0, x1, y1 = grid.bounds
    for x in np.arange(x0, x1, TILE):
        for y in np.arange(y0, y1, TILE):
            grid.window((x + 1, y + 1, x + 2, y + 2))
    assert 90e6 < grid.bytes < 150e6, "machines worked everywhere"
