"""Surfaces of triangles: those that records tell, simplified within a budget, and those of round bodies.

Of a simplified one it is known how far it is off at most. That is why its corners are joined cell by cell (J. Rossignac
and P. Borrel, 1993) and not edge by edge, as libraries do it: they look better, and bound nothing.
"""

import math
import zlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tms_config.models import Box
from tms_control.links import Array

BUDGET = 10_000  # triangles of a surface that is planned with: five megabytes
FINER = 1.2  # cells grow by this factor until the budget is met
SIDES = 24  # of a body that is round
THIN = 1e-3  # m, breadth of a triangle in place of a line or a point

Faces = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Mesh:
    """Corners (N x 3, m), triangles of their numbers (M x 3), and how far it is off the true surface at most [m]."""

    vertices: Array
    faces: Faces
    off: float = 0.0

    @cached_property
    def key(self) -> int:
        """The same for the same surface."""
        return zlib.crc32(self.faces.tobytes(), zlib.crc32(np.round(self.vertices, 3).tobytes()))

    @cached_property
    def box(self) -> Box:
        """A box around the true surface."""
        used = self.vertices[np.unique(self.faces)]
        low, high = used.min(axis=0) - self.off, used.max(axis=0) + self.off
        (x0, y0, z0), (x1, y1, z1) = low.tolist(), high.tolist()
        return Box(min=(x0, y0, z0), max=(x1, y1, z1))


def simplified(vertices: Array, faces: Faces, budget: int = BUDGET) -> Mesh:
    """The same surface, or one of at most so many triangles."""
    if len(faces) <= budget:
        return Mesh(vertices, faces)
    area = float(_areas(vertices[faces]).sum())
    span = float(np.ptp(vertices, axis=0).max())
    cell = max(math.sqrt(2 * area / budget), span / budget)
    while len((found := _joined(vertices, faces, cell)).faces) > budget:
        cell *= FINER
    return found


def _joined(vertices: Array, faces: Faces, cell: float) -> Mesh:
    """The surface with one corner, their middle, for all in a cell."""
    places = np.floor((vertices - vertices.min(axis=0)) / cell).astype(np.int64)
    rows = places.max(axis=0) + 1
    _, group, counts = np.unique(np.ravel_multi_index(tuple(places.T), tuple(rows)), return_inverse=True,
                                 return_counts=True)  # fmt: skip
    middles = np.stack([np.bincount(group, one) for one in vertices.T], axis=1) / counts[:, None]
    off = float(np.linalg.norm(vertices - middles[group], axis=1).max())
    sorted_faces = np.sort(group[faces], axis=1)
    flat = (np.diff(sorted_faces, axis=1) == 0).any(axis=1)
    whole = _unique(sorted_faces[~flat])
    return _with_lines(middles, whole, _lines(sorted_faces[flat], whole), off)


def _lines(flat: Faces, whole: Faces) -> Faces:
    """Lines and points to which triangles have shrunk, without those that are part of others: ends, N x 2."""
    ends = _unique(flat[:, [0, 2]])
    edges = {tuple(edge) for pair in ((0, 1), (1, 2), (0, 2)) for edge in whole[:, pair].tolist()}
    edges |= {(end, end) for edge in (*edges, *map(tuple, ends[ends[:, 0] != ends[:, 1]].tolist())) for end in edge}
    left = [one for one in ends.tolist() if tuple(one) not in edges]
    return np.array(left, dtype=np.int64).reshape(-1, 2)


def _unique(rows: Faces) -> Faces:
    found: Faces = np.unique(rows, axis=0)
    return found


def _with_lines(vertices: Array, faces: Faces, lines: Faces, off: float) -> Mesh:
    """Thin triangles in place of lines and points: collision checkers know no lines."""
    if not len(lines):
        return Mesh(vertices, faces, off)
    begin, end = vertices[lines[:, 0]], vertices[lines[:, 1]]
    axis = np.abs(end - begin).argmin(axis=1)
    beside = [end + THIN * np.eye(3)[one] for one in (axis, (axis + 1) % 3)]
    numbers = len(vertices) + np.arange(2 * len(lines)).reshape(2, -1)
    thin = np.column_stack([lines[:, 0], *numbers])
    return Mesh(np.concatenate([vertices, *beside]), np.concatenate([faces, thin]), off + THIN)


def cylinder(height: float, radius: float) -> Mesh:
    """Around a cylinder along z, its centre in the origin [m]."""
    return _tower([(-height / 2, radius), (height / 2, radius)])


def cone(height: float, radius: float) -> Mesh:
    """Around a cone that points along z, its origin half way up [m]."""
    return _tower([(-height / 2, radius), (height / 2, 0.0)])


def sphere(radius: float) -> Mesh:
    """Around a sphere [m]: rings of which each plane between two touches it."""
    half = math.pi / SIDES
    turns = [-math.pi / 2 + half + i * 2 * half for i in range(SIDES // 2)]
    outer = radius / math.cos(half)
    return _tower([(outer * math.sin(turn), outer * math.cos(turn)) for turn in turns])


def _tower(rings: list[tuple[float, float]]) -> Mesh:
    """A body of rings around z, from below: height and radius [m] of each; the sides lie outside of round ones."""
    turns = np.arange(SIDES) * math.tau / SIDES
    outer = 1 / math.cos(math.pi / SIDES)
    levels = [
        np.column_stack([outer * r * np.cos(turns), outer * r * np.sin(turns), np.full(SIDES, z)]) for z, r in rings
    ]
    ends = np.array([[0.0, 0.0, rings[0][0]], [0.0, 0.0, rings[-1][0]]])
    bottom, top = len(rings) * SIDES, len(rings) * SIDES + 1
    here, after = np.arange(SIDES), (np.arange(SIDES) + 1) % SIDES
    faces = [np.column_stack([np.full(SIDES, bottom), after, here])]
    for level in range(len(rings) - 1):
        low, high = level * SIDES, (level + 1) * SIDES
        faces += [np.column_stack([low + here, low + after, high + here])]
        faces += [np.column_stack([low + after, high + after, high + here])]
    faces += [np.column_stack([np.full(SIDES, top), bottom - SIDES + here, bottom - SIDES + after])]
    vertices, all_faces = np.concatenate([*levels, ends]), np.concatenate(faces)
    return Mesh(vertices, all_faces[_areas(vertices[all_faces]) > 0])


def _areas(corners: Array) -> Array:
    """Of triangles (N x 3 x 3) [m2]."""
    doubled: Array = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return doubled / 2
