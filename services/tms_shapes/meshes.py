"""Solids as meshes of triangles, by trimesh."""

from collections.abc import Iterable

import numpy as np
import trimesh
from shapely.geometry import Polygon

from tms_config.models import Solid

UPRIGHT = trimesh.transformations.rotation_matrix(np.pi / 2, [1.0, 0.0, 0.0])  # an outline lies in x-y there


def stl(parts: Iterable[Solid]) -> bytes:
    """A binary STL [m] of solids of one link."""
    bodies = [_prism(one.outline, y0, y1) for one in parts for y0, y1 in one.y]
    data: bytes = trimesh.util.concatenate(bodies).export(file_type="stl")
    return data


def _prism(outline: Iterable[tuple[float, float]], y0: float, y1: float) -> trimesh.Trimesh:
    found = trimesh.creation.extrude_polygon(Polygon(outline), y1 - y0, engine="earcut")
    found.apply_transform(UPRIGHT)  # y from -(y1 - y0) to 0
    found.apply_translation([0.0, y1, 0.0])
    return found
