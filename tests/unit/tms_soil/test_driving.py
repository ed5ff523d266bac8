"""Tracks and blades."""

import itertools
import math

import numpy as np
import pytest

from earth_rig import flat, model_of, soils
from tms_control.links import placed
from tms_soil.driving import RAKE, Grader, Rolling
from tms_soil.earth import Earth
from tms_soil.grid import BANK, COMPACTED, LOOSE, Grid
from tms_soil.resistance import force
from tms_soil.surface import Heights

TRACKS, BLADE = model_of("zx200").tracks, model_of("d37pxi").blade
assert TRACKS is not None and BLADE is not None
MIDDLE = 0.38606 - 0.10373 + BLADE.edge[1]  # m, of its edge above base_link, with all joints at 0


def sloping(x: float, y: float) -> Grid:
    level = flat()
    at_x, at_y = level.centres
    return Grid.from_heights(Heights(level.x0, level.y0, level.cell, 2.0 + x * at_x + y * at_y), soils())


@pytest.mark.parametrize("yaw", [0.0, 0.7, math.pi / 2, -2.0])
def test_a_machine_stands_as_the_ground_slopes(yaw: float) -> None:
    place = Rolling(TRACKS, sloping(0.2, -0.1)).stand(1.0, 0.5, yaw)
    assert place[2, 3] == pytest.approx(2.0 + 0.2 * 1.0 - 0.1 * 0.5, abs=0.03)
    normal = np.array([-0.2, 0.1, 1.0])
    assert place[:3, 2] == pytest.approx(normal / np.linalg.norm(normal), abs=0.01)
    assert place[:3, :3] @ place[:3, :3].T == pytest.approx(np.eye(3), abs=1e-12)
    assert math.atan2(place[1, 0], place[0, 0]) == pytest.approx(yaw, abs=1e-9)


def test_unknown_ground_counts_as_level() -> None:
    level = flat()
    x, _ = level.centres
    grid = Grid.from_heights(Heights(level.x0, level.y0, level.cell, np.where(x < 0, 1.0, np.nan)), soils())
    rolling = Rolling(TRACKS, grid)
    assert rolling.stand(0.0, 0.0, 0.0)[2] == pytest.approx([0.0, 0.0, 1.0, 1.0])
    assert rolling.stand(4.0, 0.0, 1.0) == pytest.approx(placed(4.0, 0.0, 1.0))


def drive(rolling: Rolling, length: float, steps: int) -> None:
    for k in range(steps + 1):
        rolling.step(placed(-length / 2 + length * k / steps, 0.0, 0.0))


@pytest.mark.parametrize("steps", [30, 600])
def test_a_pass_presses_two_thirds_of_the_loose_soil(steps: int) -> None:
    grid = Grid.from_heights(flat(), soils())
    window = grid.window(grid.bounds)
    assert window is not None
    window.layers[LOOSE] += 100.0
    grid.store(window)
    before = grid.mass()
    drive(Rolling(TRACKS, grid), 8.0, steps)
    window = grid.window((-0.2, -1.8, 0.2, 1.8))
    assert window is not None
    pressed = window.layers[COMPACTED][:, 2] / 100.0
    wanted = np.where(np.abs(np.abs(window.y[:, 0]) - 1.095) < 0.346, 1 - math.exp(-1), 0.0)
    assert pressed == pytest.approx(wanted, abs=0.03)
    assert window.heights().min() < 0.99 * window.heights().max(), "the rut is lower"
    assert grid.mass() == pytest.approx(before, rel=1e-14)


def test_standing_tracks_press_nothing() -> None:
    grid = Grid.from_heights(flat(), soils())
    rolling = Rolling(TRACKS, grid)
    assert [rolling.step(placed(0.0, 0.0, 0.0)) for _ in range(3)] == [[], [], []]


def push(grid: Grid, height: float, length: float = 4.0) -> Grader:
    grader = Grader(BLADE, grid)
    places = []
    for k in range(101):
        place = placed(-length / 2 + length * k / 100, 0.0, 0.0)
        place[2, 3] = height - BLADE.edge[1]
        places.append(place)
    for before, after in itertools.pairwise(places):
        grader.step(before, after)
    return grader


def test_a_blade_cuts_bumps_and_fills_hollows() -> None:
    level = flat()
    x, _ = level.centres
    grid = Grid.from_heights(Heights(level.x0, level.y0, level.cell, 0.08 * np.sin(3 * x)), soils())
    before = grid.mass()
    grader = push(grid, 0.0)
    window = grid.window((-1.4, -1.0, 1.4, 1.0))
    assert window is not None
    heights = window.heights()
    assert heights.max() < 1e-9
    assert heights.min() > -0.06, "hollows are partly filled"
    assert window.layers[LOOSE].sum() > 0
    assert grid.mass() == pytest.approx(before, rel=1e-14)
    assert grader.resistance > 0


def test_a_blade_meets_what_it_cuts_and_what_it_pushes() -> None:
    forces = []
    for length in (0.3, 2.0, 4.0):
        earth = Earth(Grid.from_heights(flat(), soils()), {"d37pxi": model_of("d37pxi")})
        for k in range(201):
            place = placed(-3.0 + length * k / 200, 0.0, 0.0)
            place[2, 3] = -0.1 - MIDDLE
            earth.report("d37pxi", length * k / 200, {}, place)
        forces.append(earth.bodies["d37pxi"].resistance)
        earth.report("d37pxi", length + 0.02, {}, place)  # it stands
        assert earth.bodies["d37pxi"].resistance == forces[-1], "a blade that stands keeps what it met"
    solid = force(soils()[0], RAKE, BLADE.width, np.array([0.1]))
    assert solid < forces[0] < forces[1] < forces[2] < 12 * solid
    assert forces[2] < 0.5 * BLADE.force, "a bulldozer pushes four metres of it"
    place = placed(0.9, 0.0, 0.0)
    place[2, 3] = 0.3
    earth.report("d37pxi", 4.04, {}, place)
    assert earth.bodies["d37pxi"].resistance == 0.0, "out of the soil"


def test_a_blade_above_the_ground_does_nothing() -> None:
    grid = Grid.from_heights(flat(), soils())
    grader = push(grid, 0.05)
    window = grid.window(grid.bounds)
    assert window is not None
    assert grader.resistance == 0.0 and not window.layers[LOOSE].any()
    assert np.ptp(window.layers[BANK]) == 0
