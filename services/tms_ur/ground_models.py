"""The ground of the site, as the API shows it."""

import math
from collections.abc import Iterable
from datetime import datetime

import numpy as np
from pydantic import Field
from tms_msg_ground.srv import GetHeights, ReadSnapshot

from tms_soil import patches, surface
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
    taken_at: datetime | None = Field(default=None, description="when it was so; null: now")
    next_at: datetime | None = Field(default=None, description="when the next ground was stored; null: none, or now")


def ground_of(answer: GetHeights.Response) -> Ground:
    """The ground in an answer of `tms:ground`, to the centimetre."""
    told = answer.ground
    return Ground(
        x0=told.x0, y0=told.y0, cell=told.cell, rows=told.rows, columns=told.columns,
        heights=_rounded(told.heights), design=_rounded(answer.design),
    )  # fmt: skip


def ground_then(answer: ReadSnapshot.Response, most: int) -> Ground:
    """A ground that the database has kept, in at most about `most` cells, to the centimetre.

    Raises:
        ValueError: see `patches.heights`.
    """
    kept = patches.heights(answer.ground)
    x0, y0, x1, y1 = kept.bounds
    cell = max(kept.cell, math.sqrt((x1 - x0) * (y1 - y0) / most))
    shown = surface.grid(kept.bounds, cell)
    z = kept.on(shown)
    rows, columns = z.shape
    return Ground(
        x0=shown.x0, y0=shown.y0, cell=cell, rows=rows, columns=columns, heights=_rounded(np.ravel(z)),
        taken_at=datetime.fromisoformat(answer.taken_at),
        next_at=datetime.fromisoformat(answer.next_at) if answer.next_at else None,
    )  # fmt: skip


def _rounded(heights: Iterable[float]) -> Heights:
    return [round(float(one), 2) if math.isfinite(one) else None for one in heights]
