"""Surfaces that records tell: `vertices`, x, y, z in turn [m], and `triangles`, three numbers of these each, from 0."""

from collections.abc import Mapping

import numpy as np

from tms_machine.reasons import BadRecord
from tms_machine.values import Value
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.meshes import Mesh, simplified
from tms_rp.reasons import MeshCorners, MeshEmpty, MeshLarge, MeshNotFinite

VERTICES, TRIANGLES = "vertices", "triangles"
MOST = 1_000_000  # triangles: a second of work for each new surface


def surface(name: str, values: Mapping[str, Value]) -> tuple[Mesh, int] | None:
    """The surface of a record, and how many triangles were told; None without the fields.

    Raises:
        SubtaskFailed: BadRecord.
    """
    told = [values.get(VERTICES), values.get(TRIANGLES)]
    if told == [None, None]:
        return None
    corners, numbers = (one if isinstance(one, list) else [] for one in told)
    if not corners or not numbers:
        raise _bad(name, MeshEmpty())
    if len(numbers) > 3 * MOST:
        raise _bad(name, MeshLarge(len(numbers) // 3, MOST))
    try:
        vertices, faces = np.asarray(corners, dtype=float), np.asarray(numbers, dtype=float)
    except (TypeError, ValueError):
        raise _bad(name, MeshNotFinite()) from None
    if not (np.isfinite(vertices).all() and np.isfinite(faces).all()):
        raise _bad(name, MeshNotFinite())
    count = len(vertices) // 3
    if len(vertices) % 3 or len(faces) % 3 or (faces % 1).any() or faces.min() < 0 or faces.max() >= count:
        raise _bad(name, MeshCorners(count))
    return simplified(vertices.reshape(-1, 3), faces.astype(np.int64).reshape(-1, 3)), len(faces) // 3


def _bad(name: str, why: Reason) -> SubtaskFailed:
    return SubtaskFailed(BadRecord(name, why))
