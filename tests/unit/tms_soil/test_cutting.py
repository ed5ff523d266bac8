"""Edges through the ground, and soil that is put down: exact volumes of prisms."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from earth_rig import flat, soils
from tms_soil.cutting import cut, depths, put_down, square_to, swept
from tms_soil.grid import BANK, LOOSE, Grid, Window

EARTH, SAND = soils("earth", "sand")


def ground(*kinds: str) -> tuple[Grid, Window]:
    grid = Grid.from_heights(flat(), soils(*kinds))
    window = grid.window((-4, -4, 4, 4))
    assert window is not None
    return grid, window


def edge(x: float, z: float, turn: float = 0.0, width: float = 1.0) -> np.ndarray:
    """Across the x axis; the left end at positive y."""
    side = np.array([-math.sin(turn), math.cos(turn), 0.0]) * width / 2
    return np.array([x, 0.0, z]) + np.array([side, -side])


def test_a_straight_cut_is_a_prism() -> None:
    _, window = ground()
    taken = cut(window, swept(window, edge(-1.0, -0.3), edge(1.0, -0.3)))
    assert taken == pytest.approx([2.0 * 1.0 * 0.3 * EARTH.bank])
    assert window.heights().min() == pytest.approx(-0.3)


@settings(max_examples=15, deadline=None)
@given(st.lists(st.floats(0.01, 0.99), max_size=12, unique=True), st.floats(-0.6, 0.6), st.floats(-0.5, 0.5))
def test_a_cut_in_steps_takes_what_a_cut_at_once_takes(steps: list[float], turn: float, rise: float) -> None:
    places = [edge(-1.5 + 3 * s, -0.5 + rise * s, turn) for s in (0.0, *sorted(steps), 1.0)]
    _, window = ground()
    whole = cut(window, swept(window, places[0], places[-1]))
    _, window = ground()
    parts = [cut(window, swept(window, a, b)) for a, b in itertools.pairwise(places)]
    assert sum(parts) == pytest.approx(whole, rel=1e-9)
    volume, row = 3 * math.cos(turn) * (0.5 - rise / 2), 3 * 0.1 * (0.5 - rise / 2)
    assert whole[0] / EARTH.bank == pytest.approx(volume, abs=1.1 * row)


def test_an_edge_takes_loose_soil_first() -> None:
    _, window = ground()
    window.layers[LOOSE] += 0.1 * EARTH.loose
    before = window.layers[BANK].copy()
    cells = swept(window, edge(-1.0, 0.02), edge(1.0, 0.02))
    assert cut(window, cells) == pytest.approx([2.0 * 0.08 * EARTH.loose])
    assert (window.layers[BANK] == before).all()
    assert cut(window, cells._replace(level=cells.level - 0.05)) == pytest.approx(
        [2.0 * (0.02 * EARTH.loose + 0.03 * EARTH.bank)]
    )


def test_nothing_is_taken_above_ground_or_where_it_is_unknown() -> None:
    _, window = ground()
    assert not cut(window, swept(window, edge(-1.0, 0.1), edge(1.0, 0.1))).any()
    window.layers[BANK] = np.nan
    assert not cut(window, swept(window, edge(-1.0, -0.5), edge(1.0, -0.5))).any()


@pytest.mark.parametrize("way", [(0.0, 0.0, -0.5), (0.0, 0.3, 0.0), (0.0, 0.0, 0.0)], ids=["down", "along", "rest"])
def test_an_edge_that_passes_no_cell_takes_nothing(way: tuple[float, float, float]) -> None:
    _, window = ground()
    place = edge(0.02, -0.5)
    assert not swept(window, place, place + np.array(way)).rows.size


def test_soil_of_each_kind_is_told_apart() -> None:
    grid = Grid.from_heights(flat(25.6), [EARTH, SAND], np.array([[0, 1], [0, 1]], dtype=np.uint8))
    window = grid.window((-2, -2, 2, 2))
    assert window is not None
    taken = cut(window, swept(window, edge(-1.0, -0.2), edge(0.5, -0.2)))
    assert taken == pytest.approx([1.0 * 0.2 * EARTH.bank, 0.5 * 0.2 * SAND.bank])


def test_soil_lies_where_it_is_put_down() -> None:
    grid, _ = ground()
    mass = grid.mass()
    put_down(grid, edge(1.0, 0.0), np.array([0.5, 0.0]), 300.0)
    assert grid.mass() - mass == pytest.approx(300.0)
    window = grid.window((1.0, -0.5, 1.5, 0.5))
    assert window is not None
    assert window.layers[LOOSE] == pytest.approx(np.full((10, 5), 300 / 0.5))
    put_down(grid, edge(9.0, 0.0), np.array([0.5, 0.0]), 100.0)
    assert (grid.mass() - mass, grid.outside) == (pytest.approx(300.0), 100.0), "beside the site"


def test_depths_are_those_of_the_ground_ahead() -> None:
    _, window = ground()
    window.layers[LOOSE][:, 40:] += 0.5 * EARTH.loose  # from x = 0 on
    assert depths(window, edge(-0.05, -0.2), np.array([1.0, 0.0])) == pytest.approx(np.full(10, 0.7))
    assert depths(window, edge(-0.05, -0.2), np.array([-1.0, 0.0])) == pytest.approx(np.full(10, 0.2))
    assert window.below(np.array([[1.0, 0.0, 0.6], [1.0, 0.0, 0.4]])) == pytest.approx([0.0, 0.1])


@pytest.mark.parametrize(("way", "wanted"), [((1.0, 5.0), (1.0, 0.0)), ((-0.1, 0.0), (-1.0, 0.0))])
def test_the_side_of_an_edge(way: tuple[float, float], wanted: tuple[float, float]) -> None:
    assert square_to(edge(0.0, 0.0), np.array(way)) == pytest.approx(wanted)
