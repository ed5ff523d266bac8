"""The ground of the site, as the API shows it."""

import math
from collections.abc import Iterable

from pydantic import Field
from tms_msg_ground.srv import GetHeights

from tms_ur.base_model import Model

Heights = list[float | None]


class Ground(Model):
    """Heights at the middles of square cells in `map`, row by row along y; no rows where the site keeps no ground."""

    x0: float = Field(default=0.0, description="m: the corner of the first cell with the least x ...")
    y0: float = Field(default=0.0, description="m: ... and the least y")
    cell: float = Field(default=1.0, description="m, side of a cell")
    rows: int = Field(default=0, description="along y")
    columns: int = Field(default=0, description="along x")
    heights: Heights = Field(default=[], description="m, null: unknown")
    design: Heights = Field(
        default=[], description="m that it should become; null: no design there; empty: none at all"
    )


def ground_of(answer: GetHeights.Response) -> Ground:
    """The ground in an answer of `tms:ground`, to the centimetre."""
    told = answer.ground
    return Ground(
        x0=told.x0, y0=told.y0, cell=told.cell, rows=told.rows, columns=told.columns,
        heights=_rounded(told.heights), design=_rounded(answer.design),
    )  # fmt: skip


def _rounded(heights: Iterable[float]) -> Heights:
    return [round(float(one), 2) if math.isfinite(one) else None for one in heights]
