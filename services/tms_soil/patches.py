"""Heights as messages."""

import numpy as np
from tms_msg_ground.msg import HeightPatch

from tms_soil.surface import Array, Heights

EACH_HOUR = "each hour"  # the source of a snapshot that only shows in the past what machines did


def patch(heights: Heights, serial: int = 0) -> HeightPatch:
    """Heights as a message, without its time."""
    rows, columns = heights.z.shape
    found = HeightPatch(
        serial=serial, x0=heights.x0, y0=heights.y0, cell=heights.cell, rows=rows, columns=columns,
        heights=numbers(heights.z),
    )  # fmt: skip
    found.header.frame_id = "map"
    return found


def numbers(z: Array) -> "np.ndarray[tuple[int, ...], np.dtype[np.float32]]":
    """Values of cells as a message has them."""
    return z.astype(np.float32).ravel()


def heights(message: HeightPatch) -> Heights:
    """Heights of a message.

    Raises:
        ValueError: it has another number of heights than cells, or no size.
    """
    size = message.rows * message.columns
    if len(message.heights) != size or not size:
        raise ValueError(f"{len(message.heights)} heights of {message.rows} x {message.columns} cells")
    if not (message.cell > 0 and np.isfinite([message.x0, message.y0, message.cell]).all()):
        raise ValueError(f"cells of {message.cell} m at ({message.x0}, {message.y0})")
    z = np.frombuffer(message.heights, dtype=np.float32).astype(np.float64)
    return Heights(message.x0, message.y0, message.cell, z.reshape(message.rows, message.columns))
