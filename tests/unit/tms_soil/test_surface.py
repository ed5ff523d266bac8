"""Heights between cells, pits with slopes, polygons."""

import numpy as np
import pytest

from tms_soil.surface import Heights, Pit, Plane, distance, grid, inside

SQUARE = ((2.0, 2.0), (6.0, 2.0), (6.0, 6.0), (2.0, 6.0))


def at(surface, x: float, y: float) -> float:
    return float(surface.at(np.array([x]), np.array([y]))[0])


def test_a_grid_covers_its_bounds_whatever_the_rounding() -> None:
    assert grid((0.0, 0.0, 20.0, 10.0), 0.2).z.shape == (50, 100)
    assert grid((0.0, 0.0, 20.01, 10.0), 0.2).z.shape == (50, 101)
    assert grid((0.0, 0.0, 0.1 * 3, 0.3), 0.1).z.shape == (3, 3)  # 0.1 * 3 is more than 0.3
    made = grid((-3.0, 4.0, 5.0, 8.0), 1.0)
    x, y = made.centres
    assert (x[0, 0], y[0, 0], x[-1, -1], y[-1, -1]) == (-2.5, 4.5, 4.5, 7.5)
    assert made.bounds == (-3.0, 4.0, 5.0, 8.0)


def test_a_plane_comes_back_between_the_cells() -> None:
    plane = Plane(1.0, slope_x=0.5, slope_y=-0.25, x=3.0, y=1.0)
    empty = grid((0.0, 0.0, 8.0, 6.0), 0.5)
    ground = Heights(0.0, 0.0, 0.5, plane.at(*empty.centres))
    places = np.random.default_rng(1).uniform([0.25, 0.25], [7.75, 5.75], (200, 2)).T
    assert np.allclose(ground.at(*places), plane.at(*places), atol=1e-12)
    assert at(ground, 0.01, 3.0) == pytest.approx(at(plane, 0.25, 3.0))  # half a cell at the edge stays level
    assert np.isnan(at(ground, -0.01, 3.0)) and np.isnan(at(ground, 3.0, 6.2)) and np.isnan(at(ground, 8.2, 3.0))


def test_an_unknown_cell_makes_only_places_beside_it_unknown() -> None:
    z = np.ones((4, 4))
    z[1, 1] = np.nan
    ground = Heights(0.0, 0.0, 1.0, z)
    assert np.isnan(at(ground, 1.9, 1.5)) and np.isnan(at(ground, 1.5, 1.5))
    assert at(ground, 2.5, 1.5) == at(ground, 0.5, 0.5) == at(ground, 3.2, 1.5) == 1.0  # at a known centre: its height


def test_a_centre_stays_known_in_spite_of_rounding() -> None:
    z = np.ones((4, 4))
    z[:, 2] = np.nan
    assert 0.1 * 3 / 0.2 - 0.5 > 1.0  # a little beyond the centre of the second column
    assert at(Heights(0.0, 0.0, 0.2, z), 0.1 * 3, 0.3) == 1.0


def test_the_same_grid_is_taken_as_it_is_and_another_is_interpolated() -> None:
    ground = Heights(0.0, 0.0, 1.0, np.arange(16.0).reshape(4, 4))
    assert ground.on(Heights(0.0, 0.0, 1.0, np.zeros((4, 4)))) is ground.z
    finer = ground.on(Heights(1.0, 1.0, 0.5, np.zeros((4, 4))))
    assert finer[0, 0] == pytest.approx(0.75 + 4 * 0.75)  # at (1.25, 1.25)


def test_a_pit_has_a_level_floor_and_slopes_up_to_its_rim() -> None:
    pit = Pit(SQUARE, level=-2.0, slope=1 / 1.5, rim=0.0)
    assert at(pit, 4.0, 4.0) == at(pit, 2.1, 5.9) == -2.0
    assert at(pit, 7.5, 4.0) == pytest.approx(-1.0)  # 1.5 m out, 1 m up
    assert at(pit, 6.0 + 0.9, 6.0 + 1.2) == pytest.approx(-1.0)  # 1.5 m from the corner
    assert np.isnan(at(pit, 9.1, 4.0)) and at(pit, 8.99, 4.0) < 0.0


def test_inside_and_distance_of_a_polygon_with_a_notch() -> None:
    notched = ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0), (0.0, 4.0))
    x, y = np.array([2.0, 2.0, 0.5, 3.5, 5.0]), np.array([0.5, 2.0, 2.0, 2.0, 0.5])
    assert inside(notched, x, y).tolist() == inside(notched[::-1], x, y).tolist() == [True, False, True, True, False]
    assert distance(SQUARE, np.array([4.0, 9.0, 9.0]), np.array([3.0, 10.0, 4.0])) == pytest.approx([1.0, 5.0, 3.0])
