"""Vessels that are filled and tipped."""

import math

import numpy as np
import pytest

from earth_rig import flat, model_of, soils
from tms_control.links import placed, turned
from tms_soil.grid import LOOSE, Grid
from tms_soil.hauling import Hauler

VESSEL = model_of("ic120").vessel
assert VESSEL is not None
DENSITY = soils()[0].loose


def hauler() -> tuple[Hauler, Grid]:
    grid = Grid.from_heights(flat(), soils())
    return Hauler(VESSEL, grid), grid


def place(tilt: float, height: float = 1.0) -> np.ndarray:
    """Its link above the origin, tipped backwards by `tilt` [deg]."""
    found = placed(0.0, 0.0, 0.0)
    found[:3, :3] = turned("y", -math.radians(tilt))
    found[2, 3] = height
    return found


def tip(one: Hauler, tilt: float, seconds: float) -> None:
    for _ in range(round(seconds / 0.02)):
        one.step(place(tilt, 2.5), 0.02)


def test_a_released_load_slides_out_as_in_the_simulator() -> None:
    one, grid = hauler()
    before = grid.mass()
    one.step(place(0), 0.02)
    one.take(np.array([4.0 * DENSITY]), np.zeros(3))
    assert one.volume == pytest.approx(4.0)
    tip(one, 60, 0.5)
    first = one.volume
    tip(one, 60, 1.9)
    assert one.volume / first == pytest.approx(math.exp(-1), rel=0.1), "time constant 1.9 s"
    tip(one, 60, 8.0 - 2.4)
    assert one.volume < 0.02 * 4.0
    tip(one, 60, 8.0)
    assert one.volume == 0.0
    assert grid.mass() - before == pytest.approx(4.0 * DENSITY, rel=1e-12)


@pytest.mark.parametrize(("tilt", "slides"), [(8.0, False), (20.0, False), (24.0, True)])
def test_friction_holds_it_up_to_22_degrees(tilt: float, slides: bool) -> None:
    one, _ = hauler()
    one.step(place(0), 0.02)
    one.take(np.array([1000.0]), np.zeros(3))
    tip(one, tilt, 3.0)
    assert (float(one.load.sum()) < 1000.0) == slides


def test_it_comes_down_behind_the_vessel() -> None:
    one, grid = hauler()
    one.step(place(0), 0.02)
    one.take(np.array([2000.0]), np.zeros(3))
    tip(one, 60, 0.4)
    window = grid.window(grid.bounds)
    assert window is not None
    rows, columns = np.nonzero(window.layers[LOOSE])
    tail = VESSEL.min[0] * math.cos(math.radians(60)) - VESSEL.min[2] * math.sin(math.radians(60))
    assert tail - 0.6 <= window.x[columns].min() and window.x[columns].max() <= tail + 0.1
    assert abs(window.y[rows, 0]).max() <= 0.9 * 1.75 / 2 + 0.05


def test_a_pile_up_to_the_vessel_slows_it() -> None:
    free, _ = hauler()
    crowded, grid = hauler()
    window = grid.window(grid.bounds)
    assert window is not None
    window.layers[LOOSE] += 3.0 * DENSITY
    grid.store(window)
    for one in (free, crowded):
        one.step(place(0), 0.02)
        one.take(np.array([1000.0]), np.zeros(3))
        tip(one, 60, 0.6)
    assert free.volume < 0.97 * crowded.volume
    assert crowded.volume > 0


def test_what_is_too_much_falls_over_the_nearest_side() -> None:
    one, grid = hauler()
    before = grid.mass()
    one.step(place(0), 0.02)
    one.take(np.array([8.0 * DENSITY]), np.array([1.5, 0.5, 3.0]))
    assert one.volume == pytest.approx(VESSEL.heaped)
    assert grid.mass() - before == pytest.approx((8.0 - VESSEL.heaped) * DENSITY)
    window = grid.window(grid.bounds)
    assert window is not None
    rows, _ = np.nonzero(window.layers[LOOSE])
    assert window.y[rows, 0].min() > 0.8, "on its left"


def test_soil_falls_into_it_only_from_above() -> None:
    one, _ = hauler()
    points = np.array([[1.0, 0.0, 3.0], [1.0, 0.8, 3.0], [1.0, 1.0, 3.0], [1.0, 0.0, 0.5]])
    assert one.below(points) == 0.0, "nobody has told where it is"
    one.step(place(0), 0.02)
    assert one.below(points) == 0.5
