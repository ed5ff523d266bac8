"""What was measured wins where nothing newer is known, and no soil appears beside the books."""

import numpy as np
import pytest

from earth_rig import flat, soils
from tms_soil.evidence import Evidence
from tms_soil.grid import BANK, COMPACTED, LOOSE, Grid
from tms_soil.measuring import measured
from tms_soil.surface import Heights

EARTH = soils()[0]


def hill(z: float = 0.0) -> Heights:
    level = flat(25.6)
    x, y = level.centres
    return Heights(level.x0, level.y0, level.cell, z + 0.05 * x + 0.3 * np.sin(y))


def known(grid: Grid) -> Evidence:
    return Evidence(grid.bounds)


def test_the_ground_gets_the_measured_heights() -> None:
    grid = Grid.from_heights(flat(25.6), soils())
    before, seen = grid.mass(), hill()
    changed, made = measured(grid, known(grid), seen, 100.0)
    assert np.abs(grid.heights().z - seen.z).max() < 1e-9 and changed
    assert grid.mass() - before == pytest.approx(made, abs=1e-6)
    again, more = measured(grid, known(grid), seen, 101.0, within=1e-6)
    assert (again, more) == ([], 0.0)


def test_a_fine_tile_gets_them_too() -> None:
    grid = Grid.from_heights(flat(25.6), soils())
    window = grid.window((-3.0, -3.0, 3.0, 3.0))
    assert window is not None
    grid.store(window)
    before, seen = grid.mass(), hill()
    _, made = measured(grid, known(grid), seen, 100.0)
    assert np.abs(grid.heights().z - seen.z)[1:-1, 1:-1].max() < 0.01, "between cells a hill is a little lower"
    assert grid.mass() - before == pytest.approx(made, abs=1e-6)


def test_newer_evidence_stays() -> None:
    grid = Grid.from_heights(flat(25.6), soils())
    evidence = known(grid)
    evidence.add([(0.0, -20.0, 20.0, 20.0)], 200.0)
    measured(grid, evidence, hill(3.0), 100.0)
    heights = grid.heights()
    x, _ = heights.centres
    assert (heights.z[x > 0] == 0.0).all() and heights.z[x < 0].min() > 1.0
    times = evidence.at(*heights.centres)
    assert (times[x > 0] == 200.0).all() and (times[x < 0] == 100.0).all()
    measured(grid, evidence, hill(3.0), 300.0)
    assert grid.heights().z.min() > 1.0


def test_a_place_that_was_not_seen_stays() -> None:
    grid = Grid.from_heights(flat(25.6), soils())
    evidence, seen = known(grid), hill(3.0)
    seen.z[:, :30] = np.nan
    measured(grid, evidence, seen, 100.0)
    assert (grid.heights().z[:, :29] == 0.0).all()
    assert np.isnan(evidence.at(*grid.heights().centres)[:, :29]).all()


def test_noise_leaves_the_ground_and_renews_the_evidence() -> None:
    grid = Grid.from_heights(flat(25.6), soils())
    evidence, level = known(grid), flat(25.6)
    noise = np.random.default_rng(1).uniform(-0.03, 0.03, level.z.shape)
    changed, made = measured(grid, evidence, Heights(level.x0, level.y0, level.cell, noise), 100.0, within=0.03)
    assert (changed, made) == ([], 0.0) and not grid.heights().z.any()
    assert (evidence.times == 100.0).all()


def test_loose_soil_goes_first_and_grows_where_it_lies() -> None:
    grid = Grid.from_heights(flat(25.6), soils())
    layers = grid.tiles[0, 0]
    layers[LOOSE] += 0.2 * EARTH.loose
    grid.put_back((0, 0), layers)
    level = flat(25.6)
    measured(grid, known(grid), Heights(level.x0, level.y0, level.cell, level.z - 0.1), 100.0)
    dug = grid.tiles[0, 0]
    assert dug[LOOSE] == pytest.approx(0.0, abs=1e-9) and not dug[COMPACTED].any()
    assert dug[BANK] / EARTH.bank + grid.datum == pytest.approx(-0.1)
    grid = Grid.from_heights(flat(25.6), soils())
    grid.put_back((0, 0), layers)
    measured(grid, known(grid), Heights(level.x0, level.y0, level.cell, level.z + 0.5), 100.0)
    assert grid.tiles[0, 0][LOOSE] / EARTH.loose == pytest.approx(0.5)
    assert not grid.tiles[1, 1][LOOSE].any(), "where none lies, what is more was always there"


def test_an_unknown_ground_becomes_known_below_what_fell_on_it() -> None:
    level = flat(25.6)
    grid = Grid.from_heights(Heights(level.x0, level.y0, level.cell, np.full_like(level.z, np.nan)), soils())
    layers = grid.tiles[0, 0]
    layers[LOOSE] += 0.2 * EARTH.loose
    grid.put_back((0, 0), layers)
    measured(grid, known(grid), Heights(level.x0, level.y0, level.cell, level.z + 1.0), 100.0)
    assert grid.heights().z == pytest.approx(1.0)
    assert grid.tiles[0, 0][LOOSE] / EARTH.loose == pytest.approx(0.2)
