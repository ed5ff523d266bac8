"""Piles and faces come to rest at their slopes, and nothing is lost."""

import math

import numpy as np
import pytest

from earth_rig import flat, soils
from tms_soil.cutting import put_down
from tms_soil.grid import BANK, FINE, LOOSE, Grid, Window
from tms_soil.slumping import settle
from tms_soil.surface import Heights

STEPS = 250  # 5 s


def rest(grid: Grid, steps: int = STEPS) -> Window:
    for _ in range(steps):
        window = grid.window((-3.2, -3.2, 3.2, 3.2))
        assert window is not None
        runs = settle(window)
        grid.store(window)
        if runs is None:
            return window
    raise AssertionError("it still runs")


def slopes(window: Window) -> np.ndarray:
    """Slopes of the surface [deg]."""
    heights = window.heights()
    x = (heights[1:-1, 2:] - heights[1:-1, :-2]) / (2 * FINE)
    y = (heights[2:, 1:-1] - heights[:-2, 1:-1]) / (2 * FINE)
    return np.degrees(np.arctan(np.hypot(x, y)))


@pytest.mark.parametrize(("kind", "mass"), [("earth", 5000.0), ("sand", 3000.0), ("clay", 2000.0)])
def test_a_pile_becomes_a_round_cone_at_its_repose(kind: str, mass: float) -> None:
    soil = soils(kind)[0]
    grid = Grid.from_heights(flat(), [soil])
    before = grid.mass()
    put_down(grid, np.array([[-0.3, -0.3, 0], [0.3, -0.3, 0]]), np.array([0.0, 0.6]), mass)
    window = rest(grid)
    assert slopes(window).max() <= soil.repose + 1.0
    assert grid.mass() - before == pytest.approx(mass, rel=1e-12)
    height = window.heights().max()
    cone = (3 * mass / soil.loose * soil.repose_slope**2 / math.pi) ** (1 / 3)
    assert height == pytest.approx(cone, rel=0.06)
    ahead, askew = window.layers[LOOSE][32], np.diag(window.layers[LOOSE])
    assert np.count_nonzero(ahead > 50) == pytest.approx(math.sqrt(2) * np.count_nonzero(askew > 50), rel=0.12)


def test_a_pile_that_is_flat_enough_stays() -> None:
    soil = soils("sand")[0]
    level = flat()
    x, _ = level.centres
    grid = Grid.from_heights(Heights(level.x0, level.y0, level.cell, 0.6 * x), [soil])
    window = grid.window((-2, -2, 2, 2))
    assert window is not None
    window.layers[LOOSE] += 100.0
    before = window.layers.copy()
    assert settle(window) is None
    assert (window.layers == before).all()


def test_a_cut_face_crumbles_to_its_own_slope() -> None:
    soil = soils("earth")[0]
    level = flat()
    x, _ = level.centres
    grid = Grid.from_heights(Heights(level.x0, level.y0, level.cell, np.where(x > 0, 1.5, 0.0)), [soil])
    before = grid.mass()
    window = rest(grid)
    solid, heights = window.solid(), window.heights()
    bare = solid[2:-2, 1:] - heights[2:-2, :-1]  # not covered by what crumbled
    assert bare.max() / FINE <= soil.face_slope * 1.02
    assert solid[32, 50] == pytest.approx(1.5), "further back it stands"
    assert window.layers[LOOSE].sum() > 0, "what crumbles is loose"
    assert grid.mass() == pytest.approx(before, rel=1e-13)


def test_soil_does_not_run_into_the_unknown_or_out_of_the_site() -> None:
    soil = soils("sand")[0]
    level = flat()
    x, _ = level.centres
    grid = Grid.from_heights(Heights(level.x0, level.y0, level.cell, np.where(x > 0.5, np.nan, 0.0)), [soil])
    put_down(grid, np.array([[0.1, -0.3, 0], [0.3, -0.3, 0]]), np.array([0.0, 0.6]), 500.0)
    window = rest(grid)
    beyond = np.isnan(window.layers[BANK])
    assert beyond.any() and window.layers[LOOSE][beyond].sum() == 0.0
    assert window.layers[LOOSE].sum() * FINE**2 == pytest.approx(500.0)
    corner = grid.window((-6.4, -6.4, -6.3, -6.3))
    assert corner is not None and settle(corner) is None
