"""The API asks for the ground in cells that a browser can hold."""

import math
from datetime import datetime, timedelta, timezone
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tms_msg_ground.msg import HeightPatch
from tms_msg_ground.srv import GetHeights, ReadSnapshot

from tms_reason.errors import TmsError
from tms_soil import patches
from tms_soil.surface import Heights
from tms_ur.ground_client import ground, ground_at
from tms_ur.reasons import GroundNotRead

THEN = datetime(2026, 11, 26, 12, tzinfo=timezone.utc)


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


def kept(answer: ReadSnapshot.Response) -> Any:
    """A database with one ground."""
    return SimpleNamespace(call=lambda *asked: answer)


def test_a_ground_of_then_is_shown_in_cells_that_a_browser_can_hold() -> None:
    told = patches.patch(Heights(5.0, 0.0, 0.2, np.full((100, 200), 1.234)))
    facts = {"taken_at": "2026-11-26T12:00:00+00:00", "next_at": "2026-11-26T13:00:00+00:00"}
    found = ground_at(kept(ReadSnapshot.Response(ground=told, **facts)), THEN, 5000)
    assert (found.x0, found.cell, found.rows, found.columns) == (5.0, pytest.approx(0.4), 50, 100)
    assert found.heights == [1.23] * 5000 and found.design == []
    assert (found.taken_at, found.next_at) == (THEN, THEN + timedelta(hours=1))
    newest = ground_at(kept(ReadSnapshot.Response(ground=told, taken_at=facts["taken_at"])), THEN, 20_000)
    assert (newest.next_at, newest.cell, len(newest.heights)) == (None, pytest.approx(0.2), 20_000)


def test_a_ground_of_then_that_cannot_be_read_is_told() -> None:
    answer = ReadSnapshot.Response(taken_at=THEN.isoformat())
    answer.ground.rows = 3
    with pytest.raises(TmsError) as caught:
        ground_at(kept(answer), THEN, 5000)
    assert isinstance(caught.value.reason, GroundNotRead)
