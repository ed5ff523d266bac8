"""Cut and fill between two surfaces, by cells, and how far unknown cells make them uncertain."""

import math
from dataclasses import dataclass

import numpy as np

from tms_soil.surface import Array, Heights, Mask, Surface


@dataclass(frozen=True)
class Volumes:
    """What lies between two surfaces.

    Of an unknown cell is assumed that it changed by no more than the known cell that changed most. If no cell is known,
    the upper bounds are infinite.
    """

    cut: float  # m3, where the second surface is lower
    fill: float  # m3, where the second surface is higher
    area: float  # m2, of the compared cells
    unknown: float  # m2, of cells that should be compared and of which a height is unknown
    cut_at_most: float  # m3, with the unknown cells
    fill_at_most: float  # m3, with the unknown cells

    @property
    def net(self) -> float:
        """Fill less cut [m3]."""
        return self.fill - self.cut


def between(before: Heights, after: Heights, mask: Mask | None = None) -> Volumes:
    """Cut and fill from one ground to another, by the cells of the later one.

    Args:
        before: heights on any grid; on another one than `after`'s they are interpolated.
        after: heights.
        mask: which cells of `after` count; None: all.
    """
    return _volumes(after.z - before.on(after), after.cell, np.ones(after.z.shape, np.bool_) if mask is None else mask)


def against(ground: Heights, design: Surface, mask: Mask | None = None) -> Volumes:
    """Cut and fill that a ground still needs to become the design; cells without a design do not count.

    Args:
        ground: heights.
        design: the surface to reach.
        mask: which cells of `ground` count; None: all.
    """
    wanted = design.at(*ground.centres)
    designed = np.isfinite(wanted) if mask is None else np.isfinite(wanted) & mask
    return _volumes(wanted - ground.z, ground.cell, designed)


def _volumes(rise: Array, cell: float, mask: Mask) -> Volumes:
    known = mask & np.isfinite(rise)
    changes = rise[known]
    cut = float(-np.sum(changes[changes < 0])) * cell**2
    fill = float(np.sum(changes[changes > 0])) * cell**2
    unknown = float(np.count_nonzero(mask & ~known)) * cell**2
    deepest = max(0.0, -float(changes.min())) if changes.size else math.inf
    highest = max(0.0, float(changes.max())) if changes.size else math.inf
    return Volumes(
        cut, fill, changes.size * cell**2, unknown,
        cut + (unknown * deepest if unknown else 0.0), fill + (unknown * highest if unknown else 0.0),
    )  # fmt: skip
