"""A scanner sees what is near and not behind something; its points become heights again."""

import math

import numpy as np
import pytest

from tms_soil.scanning import gathered, visible
from tms_soil.surface import Heights


def ground(shape=lambda x, _: 0 * x) -> Heights:
    found = Heights(-15.0, -15.0, 0.1, np.zeros((300, 300)))
    found.z[:] = shape(*found.centres)
    return found


def test_on_level_ground_it_sees_all_that_is_near() -> None:
    told = ground()
    x, y = told.centres
    seen, away = visible(told, (1.0, -2.0, 5.0), 12.0), np.sqrt((x - 1) ** 2 + (y + 2) ** 2 + 25)
    assert np.array_equal(seen, away <= 12.0)


def test_a_wall_throws_its_shadow() -> None:
    told = ground(lambda x, y: np.where((np.abs(x - 4.0) < 0.3) & (np.abs(y) < 2.0), 2.0, 0.0))
    x, y = told.centres
    seen = visible(told, (0.0, 0.0, 4.0), 30.0)
    # From 4 m up, a wall of 2 m at 4.3 m hides the ground as far as 8.6 m.
    assert not seen[(np.abs(y) < 1.5) & (x > 4.5) & (x < 8.2)].any()
    assert seen[(np.abs(y) < 1.5) & (x > 8.9) & (x < 14.0)].all()
    assert seen[(x < 3.5)].all() and seen[(np.abs(x - 4.0) < 0.25) & (np.abs(y) < 1.5)].any()
    assert seen[(np.abs(y) > 5.0) & (x < 8.0)].all(), "beside it"


def test_it_does_not_see_the_bottom_of_a_pit_and_not_what_is_unknown() -> None:
    told = ground(lambda x, y: np.where((x > 6.0) & (x < 8.0), -2.0, np.where(y > 10.0, np.nan, 0.0)))
    x, y = told.centres
    seen = visible(told, (0.0, 0.0, 1.5), 30.0)
    assert not seen[(x > 6.2) & (x < 7.8) & (np.abs(y) < 4)].any() and not seen[y > 10.1].any()


@pytest.mark.parametrize("cell", [0.1, 0.25])
def test_points_become_heights(cell: float) -> None:
    chance = np.random.default_rng(2)
    points = chance.uniform((-3.0, 1.0, 0.0), (4.0, 6.0, 0.0), (20000, 3))
    points[:, 2] = 2.0 + 0.1 * points[:, 0]
    points[::100] = math.nan
    found = gathered(points, cell)
    x, y = found.centres
    assert found.bounds == pytest.approx((-3.0, 1.0, 4.0, 6.0), abs=cell)
    assert np.nanmax(np.abs(found.z - 2.0 - 0.1 * x)) < 0.1 * cell and np.isfinite(found.z).mean() > 0.9
    assert abs(found.x0 / cell - round(found.x0 / cell)) < 1e-9 and y.min() > 1.0


@pytest.mark.parametrize("points", [[[0.0, 0.0, math.nan]], [[0.0, 0.0, 0.0], [1e6, 0.0, 0.0]]])
def test_what_is_no_cloud_of_a_site_is_refused(points: list[list[float]]) -> None:
    with pytest.raises(ValueError):
        gathered(np.array(points), 0.1)
