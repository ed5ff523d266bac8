"""What a scanner sees of the ground, and heights from points that were scanned."""

import math

import numpy as np

from tms_soil.surface import Array, Heights, Mask

SIDE = 2000  # cells along a side of what points may cover


def visible(ground: Heights, eye: tuple[float, float, float], reach: float) -> Mask:
    """Which cells a scanner sees whose eye is at a place [m of map]: up to `reach` [m] and not behind higher ground.

    Rays go out in all directions, cell by cell; a cell is seen when no earlier one on its ray stands higher, as seen
    from the eye.
    """
    x, y = ground.centres
    dx, dy = x - eye[0], y - eye[1]
    away = np.hypot(dx, dy)
    rays, steps = math.ceil(math.tau * reach / ground.cell), math.ceil(reach / ground.cell) + 1
    bearing = math.tau * np.arange(rays) / rays
    rings = ground.cell * (np.arange(steps) + 0.5)
    at = eye[0] + np.outer(np.cos(bearing), rings), eye[1] + np.outer(np.sin(bearing), rings)
    rise = np.nan_to_num((ground.at(*at) - eye[2]) / rings, nan=-np.inf)
    horizon = np.maximum.accumulate(rise, axis=1)
    ray = np.round((np.arctan2(dy, dx) % math.tau) / math.tau * rays).astype(np.intp) % rays
    before = np.floor(away / ground.cell - 1.5).astype(np.intp)  # the last ring that is a cell nearer
    hidden = np.where(before >= 0, horizon[ray, np.clip(before, 0, steps - 1)], -np.inf)
    seen = np.hypot(away, ground.z - eye[2]) <= reach
    return np.isfinite(ground.z) & seen & ((ground.z - eye[2]) / np.maximum(away, ground.cell / 2) >= hidden)


def gathered(points: Array, cell: float) -> Heights:
    """Mean heights of points of map (N x 3) by cells [m] at whole multiples of their side; NaN where there is none.

    Raises:
        ValueError: there is no finite point, or they cover too much.
    """
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        raise ValueError("no points")
    at = np.floor(points[:, :2] / cell + 1e-6)
    low = at.min(axis=0)
    columns, rows = (at.max(axis=0) - low + 1).tolist()
    if max(columns, rows) > SIDE:
        raise ValueError(f"{columns:.0f} x {rows:.0f} cells")
    shape = int(rows), int(columns)
    index = np.ravel_multi_index(tuple((at - low).astype(np.intp).T[::-1]), shape)
    counts = np.bincount(index, minlength=shape[0] * shape[1])
    sums = np.bincount(index, weights=points[:, 2], minlength=len(counts))
    z = np.where(counts > 0, sums / np.maximum(counts, 1), np.nan)
    return Heights(float(low[0]) * cell, float(low[1]) * cell, cell, z.reshape(shape))
