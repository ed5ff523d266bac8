"""Triangles over a grid: no cell is missed, none outside is touched."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tms_ground.files import triangles
from tms_ground.files.triangles import heights


@given(st.integers(0, 2**32 - 1))
def test_random_triangles_equal_a_plain_search(seed: int) -> None:
    random = np.random.default_rng(seed)
    corners = np.round(random.uniform(-3, 15, (4, 3, 3)) * 2) / 2  # also on whole cells
    found = heights(corners, (9, 12))
    rows, columns = np.mgrid[0:9, 0:12]
    touched = np.zeros((9, 12), bool)
    for a, b, c in corners:
        sides = [(q[0] - p[0]) * (rows - p[1]) - (q[1] - p[1]) * (columns - p[0]) for p, q in ((a, b), (b, c), (c, a))]
        if (b[0] - a[0]) * (c[1] - a[1]) != (b[1] - a[1]) * (c[0] - a[0]):
            touched |= np.all([side >= 0 for side in sides], axis=0) | np.all([side <= 0 for side in sides], axis=0)
    assert (np.isfinite(found) == touched).all()


def test_parts_of_a_large_triangle_are_as_the_whole(monkeypatch) -> None:
    corners = np.array(
        [
            [[-1.0, -1.0, 0.0], [40.0, 2.0, 4.0], [5.0, 38.0, -2.0]],
            [[40.0, 2.0, 4.0], [39.0, 38.0, 1.0], [5.0, 38.0, -2.0]],
        ]
    )
    whole = heights(corners, (40, 41))
    monkeypatch.setattr(triangles, "AT_ONCE", 7)
    assert np.array_equal(heights(corners, (40, 41)), whole, equal_nan=True)
    assert np.isfinite(whole).sum() > 900
