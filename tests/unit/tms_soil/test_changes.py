"""Where the ground has changed: all of it is told, tile by tile."""

import random

import numpy as np
import pytest

from earth_rig import flat, soils
from tms_soil.changes import Changes
from tms_soil.grid import FINE, TILE, Grid


@pytest.mark.parametrize("seed", range(5))
def test_what_is_told_covers_what_has_changed(seed: int) -> None:
    chance, grid = random.Random(seed), Grid.from_heights(flat(51.2), soils())
    changes, x0, y0 = Changes(grid), grid.x0, grid.y0
    missing = np.zeros((512, 512), dtype=bool)
    for _ in range(12):
        x, y = (chance.uniform(-30, 28) for _ in "xy")
        wide, high = chance.uniform(0.1, 20), chance.uniform(0.1, 3)
        changes.add([(x, y, x + wide, y + high)])
        missing |= ((grid.x > x) & (grid.x < x + wide)) & ((grid.y > y) & (grid.y < y + high))[:, None]
        told = changes.take(3)
        assert len(told) <= 3
        for one in told:
            assert one[2] - one[0] <= TILE + FINE and one[3] - one[1] <= TILE + FINE
            forget(missing, one, x0, y0)
    for one in changes.take(100):
        forget(missing, one, x0, y0)
    assert not missing.any() and changes.take(1) == []


def forget(missing: np.ndarray, told: tuple[float, float, float, float], x0: float, y0: float) -> None:
    low = [int(np.floor((v - o) / FINE)) for v, o in zip(told[:2], (x0, y0), strict=True)]
    high = [int(np.ceil((v - o) / FINE)) for v, o in zip(told[2:], (x0, y0), strict=True)]
    missing[low[1] : high[1], low[0] : high[0]] = False


def test_a_place_that_changes_all_the_time_does_not_keep_others_waiting() -> None:
    changes = Changes(Grid.from_heights(flat(51.2), soils()))
    told = []
    for _ in range(3):
        changes.add([(-20.0, -20.0, -19.0, -19.0), (20.0, 20.0, 21.0, 21.0)])
        told += changes.take(1)
    assert {one[0] for one in told} == {-20.0, 20.0}
