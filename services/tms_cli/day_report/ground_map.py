"""The change of the ground as a picture: red where it was lowered, blue where it was raised, grey where unknown."""

import io
from typing import Any

import numpy as np

from tms_soil.surface import Array, Heights, Mask

LOWERED, RAISED, SAME, UNKNOWN = (178, 24, 43), (33, 102, 172), (247, 247, 247), (150, 150, 150)  # red, blue, greys
LEAST = 0.05  # m of change that has the full colour where nothing has changed more
SMALL, LARGE = 240, 2000  # pixels along the longer side


def change(before: Heights, after: Heights, mask: Mask | None = None) -> Array:
    """By how much each cell of `after` is higher [m]; NaN where that is unknown or not asked."""
    rise = after.z - before.on(after)
    return rise if mask is None else np.where(mask, rise, np.nan)


def full_colour(rise: Array) -> float:
    """The change [m] that has the full colour."""
    known = np.abs(rise[np.isfinite(rise)])
    return max(LEAST, float(known.max())) if known.size else LEAST


def picture(rise: Array) -> bytes:
    """A PNG of the change; y points upwards."""
    from PIL import Image

    share = np.nan_to_num(rise / full_colour(rise))[..., None]
    to = np.where(share < 0, np.array(LOWERED), np.array(RAISED))
    colours = np.array(SAME) + np.abs(share) * (to - np.array(SAME))
    colours = np.where(np.isfinite(rise)[..., None], colours, np.array(UNKNOWN))
    image = Image.fromarray(colours.round().astype(np.uint8)[::-1].copy())
    factor = max(1, SMALL // max(image.size)) if max(image.size) <= LARGE else LARGE / max(image.size)
    if factor != 1:
        size = (max(1, round(image.width * factor)), max(1, round(image.height * factor)))
        image = image.resize(size, Image.Resampling.NEAREST)
    out = io.BytesIO()
    image.save(out, "PNG")
    return out.getvalue()


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
