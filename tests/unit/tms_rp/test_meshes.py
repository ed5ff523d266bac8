"""Surfaces: what a record may tell, how far a simplified one is off, and that round bodies lie inside theirs."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_machine.reasons import BadRecord
from tms_machine.values import Value
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.meshes import Mesh, cone, cylinder, simplified, sphere
from tms_rp.reasons import MeshCorners, MeshEmpty, MeshLarge, MeshNotFinite
from tms_rp.told_mesh import MOST, surface

CORNERS = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]


def refusal(**values: Value) -> Reason:
    with pytest.raises(SubtaskFailed) as caught:
        surface("collision_object_heap", values)
    assert isinstance(caught.value.reason, BadRecord) and caught.value.reason.record == "collision_object_heap"
    return caught.value.reason.problem


@pytest.mark.parametrize(
    ("values", "why"),
    [
        ({"vertices": [], "triangles": []}, MeshEmpty()),
        ({"vertices": CORNERS}, MeshEmpty()),
        ({"triangles": [0, 1, 2]}, MeshEmpty()),
        ({"vertices": [*CORNERS[:-1], math.nan], "triangles": [0, 1, 2]}, MeshNotFinite()),
        ({"vertices": [*CORNERS[:-1], math.inf], "triangles": [0, 1, 2]}, MeshNotFinite()),
        ({"vertices": ["a", "b", "c"], "triangles": [0, 1, 2]}, MeshNotFinite()),
        ({"vertices": CORNERS, "triangles": [0, 1, 3]}, MeshCorners(3)),
        ({"vertices": CORNERS, "triangles": [0, -1, 2]}, MeshCorners(3)),
        ({"vertices": CORNERS, "triangles": [0.5, 1.0, 2.0]}, MeshCorners(3)),
        ({"vertices": CORNERS, "triangles": [0, 1]}, MeshCorners(3)),
        ({"vertices": CORNERS[:-1], "triangles": [0, 1, 1]}, MeshCorners(2)),
        ({"vertices": CORNERS, "triangles": [0, 1, 2] * (MOST + 1)}, MeshLarge(MOST + 1, MOST)),
    ],
)
def test_a_surface_that_makes_no_sense_is_refused(values: dict[str, Value], why: Reason) -> None:
    assert refusal(**values) == why


def test_a_small_surface_is_kept() -> None:
    told = surface("heap", {"vertices": CORNERS, "triangles": [0, 1, 2]})
    assert told is not None and (told[0].off, told[1]) == (0.0, 1)
    assert told[0].vertices.ravel().tolist() == CORNERS and told[0].faces.tolist() == [[0, 1, 2]]
    assert surface("heap", {"x": 1.0}) is None


def heap(side: int) -> tuple[np.ndarray, np.ndarray]:
    """A heap of soil of 2 x side x side triangles, 10 m across."""
    x, y = np.meshgrid(np.linspace(-5, 5, side + 1), np.linspace(-5, 5, side + 1))
    z = 3 * np.exp(-(x**2 + y**2) / 8) + 0.1 * np.sin(7 * x) * np.cos(5 * y)
    low = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    faces = np.concatenate([np.column_stack([low, low + 1, low + side + 1]),
                            np.column_stack([low + 1, low + side + 2, low + side + 1])])  # fmt: skip
    return np.column_stack([x.ravel(), y.ravel(), z.ravel()]), faces


def away(points: np.ndarray, mesh: Mesh) -> float:
    """How far the points are from the surface at most, by its triangles one by one."""
    least = np.full(len(points), math.inf)
    for a, b, c in mesh.vertices[mesh.faces]:
        least = np.minimum(least, to_triangle(points, a, b, c))
    return float(least.max())


def to_triangle(points: np.ndarray, a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    edges = [(a, b), (b, c), (c, a)]
    near = np.min([to_line(points, *edge) for edge in edges], axis=0)
    normal = np.cross(b - a, c - a)
    if not normal.any():
        return near
    normal = normal / np.linalg.norm(normal)
    inside = np.all([np.cross(q - p, points - p) @ normal >= 0 for p, q in edges], axis=0)
    return np.where(inside, np.abs((points - a) @ normal), near)


def to_line(points: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    share = np.clip((points - a) @ (b - a) / max(float((b - a) @ (b - a)), 1e-12), 0, 1)
    return np.linalg.norm(points - a - share[:, None] * (b - a), axis=1)


def test_of_a_simplified_surface_it_is_known_how_far_it_is_off() -> None:
    vertices, faces = heap(60)
    found = simplified(vertices, faces, budget=500)
    assert 250 < len(found.faces) <= 500
    assert 0.1 < found.off < 0.8
    middles = vertices[faces].mean(axis=1)
    assert away(np.concatenate([vertices, middles])[::7], found) <= found.off + 1e-9
    assert (np.array(found.box.max) >= vertices.max(axis=0)).all() and (
        np.array(found.box.min) <= vertices.min(axis=0)
    ).all()


@given(st.integers(0, 10**6))
def test_nothing_of_a_thin_or_torn_surface_is_lost(seed: int) -> None:
    rng = np.random.default_rng(seed)
    vertices = rng.uniform(0, 1, (60, 3)) * rng.choice([0.01, 1.0, 10.0], 3)
    faces = rng.integers(0, 60, (80, 3))
    found = simplified(vertices, faces, budget=20)
    assert 0 < len(found.faces) <= 20
    assert away(vertices[faces].mean(axis=1), found) <= found.off + 1e-9


@pytest.mark.turns
def test_a_million_triangles_are_simplified_within_the_budget() -> None:
    vertices, faces = heap(707)
    assert len(faces) > 999_000
    found = simplified(vertices, faces)
    assert 5000 < len(found.faces) <= 10_000 and found.off < 0.2


@pytest.mark.parametrize(
    ("mesh", "inside"),
    [
        (sphere(2.0), lambda p: np.linalg.norm(p, axis=1) <= 2.0),
        (cylinder(3.0, 1.0), lambda p: (np.hypot(p[:, 0], p[:, 1]) <= 1.0) & (np.abs(p[:, 2]) <= 1.5)),
        (cone(3.0, 1.0), lambda p: (np.hypot(p[:, 0], p[:, 1]) <= (1.5 - p[:, 2]) / 3) & (np.abs(p[:, 2]) <= 1.5)),
    ],
)
def test_a_round_body_lies_inside_its_surface_and_just_so(mesh: Mesh, inside: object) -> None:
    assert callable(inside)
    points = np.random.default_rng(1).uniform(-2, 2, (4000, 3))
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    out = np.max(points @ normals.T - (a * normals).sum(axis=1), axis=1)  # convex: how far beyond its planes
    assert (out[inside(points)] <= 1e-9).all()
    corners = mesh.vertices[np.unique(mesh.faces)]
    assert not inside(corners * 0.95).all() or inside(corners * 0.93).all()
