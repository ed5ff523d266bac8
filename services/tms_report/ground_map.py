"""The change of the ground between two times."""

from typing import Any

import numpy as np

from tms_soil.surface import Array, Heights, Mask

LEAST = 0.05  # m of change that has the full colour where nothing has changed more
FULL = 98  # percent of what has changed by LEAST has no more than the full colour: a high pile hides no flat cut


def change(before: Heights, after: Heights, mask: Mask | None = None) -> Array:
    """By how much each cell of `after` is higher [m]; NaN where that is unknown or not asked."""
    rise = after.z - before.on(after)
    return rise if mask is None else np.where(mask, rise, np.nan)


def full_colour(rise: Array) -> float:
    """The change [m] that has the full colour; larger ones have it, too."""
    changed = np.abs(rise[np.isfinite(rise)])
    changed = changed[changed >= LEAST]
    return float(np.percentile(changed, FULL)) if changed.size else LEAST


def extremes(ground: Heights, rise: Array) -> dict[str, Any]:
    """How much was lowered and raised most [m], and where [m, map]; empty where nothing is known."""
    if not np.isfinite(rise).any():
        return {}
    x, y = ground.centres
    found: dict[str, Any] = {}
    for name, at in (("deepest", np.nanargmin(rise)), ("highest", np.nanargmax(rise))):
        place = np.unravel_index(at, rise.shape)
        found |= {f"{name}_m": float(rise[place]), f"{name}_x": float(x[place]), f"{name}_y": float(y[place])}
    return found
