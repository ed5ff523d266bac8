"""The API asks for the ground in cells that a browser can hold."""

import math
from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_ground.msg import HeightPatch
from tms_msg_ground.srv import GetHeights

from tms_ur.ground_client import ground


def site(metres: float, asked: list[float]) -> Any:
    """A square site, whose ground is flat and in one place unknown."""

    def call(_: Any, service: str, request: GetHeights.Request, limit: float) -> GetHeights.Response:
        asked.append(request.cell)
        side = math.ceil(metres / request.cell)
        heights = [1.234, math.nan] * (side * side // 2) + [0.0] * (side * side % 2)
        told = HeightPatch(cell=request.cell, rows=side, columns=side, heights=heights)
        return GetHeights.Response(ground=told, design=[0.5] * (side * side))

    return SimpleNamespace(call=call)


@pytest.mark.parametrize(("metres", "cell"), [(20.0, 0.2), (200.0, 2.0), (3000.0, 10.0)])
def test_cells_are_as_small_as_the_number_allows(metres: float, cell: float) -> None:
    asked: list[float] = []
    found = ground(site(metres, asked), 10_000)
    assert asked[-1] == pytest.approx(cell)
    assert found.rows * found.columns == len(found.heights or ())
    assert (found.heights or [])[:2] == [1.23, None] and found.design[0] == 0.5
