"""A map of the change of the ground as PNG: around where it has changed, with coordinates and a scale of colours."""

import io
import math
from collections.abc import Iterator

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from tms_report.ground_map import full_colour
from tms_soil.surface import Array, Bounds, Heights

LOWERED, RAISED, SAME, UNKNOWN = (178, 24, 43), (33, 102, 172), (247, 247, 247), (150, 150, 150)  # red, blue, greys
INK, GRID = (51, 51, 51), (205, 205, 205)
FAINT = 0.6  # exponent of the colours' strength: below 1, small changes are seen beside large ones
AROUND = 3.0  # m beside what has changed
SMALLEST = 10.0  # m, side of what is shown, if the ground is as large
SIDE = 900  # pixels of the longer side, about
LEFT, RIGHT, TOP, BOTTOM = 90, 150, 14, 44  # pixels round the map
LETTERS, TICK, BAR = 22, 8, 26  # pixels
TICKS = 8  # coordinates along a side, at most


def picture(ground: Heights, rise: Array) -> bytes:
    """Red where the ground was lowered, blue where it was raised, grey where that is unknown; y points upwards.

    `rise`: by how much each cell of `ground` is higher [m], or NaN.
    """
    rows, columns = _shown(rise, ground.cell)
    full = full_colour(rise)
    cells = Image.fromarray(_colours(rise[rows, columns], full)[::-1].copy())
    scale = SIDE / max(cells.size)  # pixels a cell
    scale = max(1, round(scale)) if scale >= 1 else scale
    size = max(1, round(cells.width * scale)), max(1, round(cells.height * scale))
    x0, y0 = ground.x0 + columns.start * ground.cell, ground.y0 + rows.start * ground.cell
    bounds = x0, y0, x0 + cells.width * ground.cell, y0 + cells.height * ground.cell
    page = Image.new("RGB", (LEFT + size[0] + RIGHT, TOP + size[1] + BOTTOM), (255, 255, 255))
    page.paste(cells.resize(size, Image.Resampling.NEAREST), (LEFT, TOP))
    _coordinates(page, bounds, size)
    _scale(page, size, full)
    out = io.BytesIO()
    page.save(out, "PNG")
    return out.getvalue()


def _shown(rise: Array, cell: float) -> tuple[slice, slice]:
    """The rows and columns around what has changed; all, where nothing has."""
    changed = np.abs(np.nan_to_num(rise)) >= 0.05 * full_colour(rise)
    if not changed.any():
        return slice(0, rise.shape[0]), slice(0, rise.shape[1])
    found = []
    for axis, count in ((1, rise.shape[0]), (0, rise.shape[1])):
        (at,) = np.nonzero(changed.any(axis=axis))
        beside = max(AROUND / cell, (SMALLEST / cell - (at[-1] - at[0] + 1)) / 2)
        found.append(slice(max(0, math.floor(at[0] - beside)), min(count, math.ceil(at[-1] + 1 + beside))))
    return found[0], found[1]


def _colours(rise: Array, full: float) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    share = np.clip(np.nan_to_num(rise / full), -1.0, 1.0)[..., None]
    to = np.where(share < 0, np.array(LOWERED), np.array(RAISED))
    colours = np.array(SAME) + np.abs(share) ** FAINT * (to - np.array(SAME))
    known = np.isfinite(rise)[..., None]
    return np.where(known, colours, np.array(UNKNOWN)).round().astype(np.uint8)


def _coordinates(page: Image.Image, bounds: Bounds, size: tuple[int, int]) -> None:
    """Lines at round x and y [m, map], with their numbers."""
    draw, font = ImageDraw.Draw(page), ImageFont.load_default(LETTERS)
    x0, y0, x1, y1 = bounds
    step = _round_step(max(x1 - x0, y1 - y0) / TICKS)
    low, right = TOP + size[1], LEFT + size[0]
    for x in _ticks(x0, x1, step):
        at = LEFT + (x - x0) / (x1 - x0) * size[0]
        draw.line((at, TOP, at, low + TICK), GRID)
        draw.text((at, low + TICK), f"{x:g}", INK, font, anchor="ma")
    for y in _ticks(y0, y1, step):
        at = low - (y - y0) / (y1 - y0) * size[1]
        draw.line((LEFT - TICK, at, right, at), GRID)
        draw.text((LEFT - TICK - 3, at), f"{y:g}", INK, font, anchor="rm")
    draw.text((right + TICK, low + TICK), "m", INK, font, anchor="la")
    draw.rectangle((LEFT, TOP, right, low), outline=INK)


def _scale(page: Image.Image, size: tuple[int, int], full: float) -> None:
    """The colours, from raised to lowered."""
    draw, font = ImageDraw.Draw(page), ImageFont.load_default(LETTERS)
    height, left = min(size[1], 300), LEFT + size[0] + 24
    colours = _colours(np.linspace(full, -full, height)[:, None], full)
    page.paste(Image.fromarray(colours).resize((BAR, height)), (left, TOP))
    draw.rectangle((left, TOP, left + BAR, TOP + height), outline=INK)
    for at, text, anchor in ((0, f"+{full:.2f} m", "lt"), (0.5, "0", "lm"), (1, f"-{full:.2f} m", "lb")):
        draw.text((left + BAR + TICK, TOP + at * height), text, INK, font, anchor=anchor)


def _round_step(least: float) -> float:
    """The least of 1, 2, 5 times a power of ten that is not smaller."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= least - 1e-9)


def _ticks(low: float, high: float, step: float) -> Iterator[float]:
    for k in range(math.ceil(low / step), math.floor(high / step) + 1):
        yield k * step
