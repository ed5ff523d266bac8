"""In random scenes no way touches anything, by a second implementation that shares no code with the first.

The second one multiplies the frames of the URDF pose by pose, and compares boxes by all their 15 separating axes, boxes
and triangles by theirs.
"""

import math
import random
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from examples import examples
from random_scenes import random_heap, random_pose, random_scene
from tms_config.config import CONFIGS
from tms_config.models import Box, MachineModel
from tms_config.yaml_file import parse
from tms_reason.errors import SubtaskFailed
from tms_rp.kind import Angles, Moves
from tms_rp.kinds import load
from tms_rp.reasons import Collision, NoWayRound, PartOf
from tms_rp.scene import Obstacle, Scene
from tms_rp.trajectory import Trajectory
from tms_rp.ways import Ways

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
WAYS = Ways(MODEL, load("backhoe"))
SCENES = examples(200, 5000)
DENSE = 0.005  # rad
GROUND = Box(min=(-20.0, -20.0, -1.0), max=(20.0, 20.0, 0.0))
ARM = ("boom_link", "arm_link", "bucket_link")
OWN = (("track_link", "boom_link"), ("track_link", "arm_link"), ("track_link", "bucket_link"),
       ("body_link", "arm_link"), ("body_link", "bucket_link"))  # fmt: skip
Array = NDArray[np.float64]
Placed = tuple[Array, Array, Array]  # axes as columns (N x 3 x 3), centre (N x 3), half sizes


def rotation(axis: str, angles: Array) -> Array:
    """Rodrigues' formula."""
    x, y, z = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}[axis]
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]], dtype=float)
    turn = angles[:, None, None]
    return np.eye(3) + np.sin(turn) * k + (1 - np.cos(turn)) * (k @ k)


def of_box(box: Box, turn: Array, at: Array) -> Placed:
    low, high = np.array(box.min), np.array(box.max)
    axes = turn @ rotation("y", np.array([box.pitch]))
    return axes, at + axes @ ((low + high) / 2), (high - low) / 2


def bodies(poses: Array) -> dict[str, Placed]:
    frames = {"base_link": (np.tile(np.eye(3), (len(poses), 1, 1)), np.zeros((len(poses), 3)))}
    columns = list(MODEL.joints)
    for joint, origin in MODEL.geometry.items():
        turn, at = frames[origin.parent]
        angles = poses[:, columns.index(joint)] if joint in columns else np.zeros(len(poses))
        pitched = turn @ rotation("y", np.full(len(poses), origin.pitch))
        frames[origin.child] = pitched @ rotation(origin.axis, angles), at + turn @ np.array(origin.xyz)
    return {link: of_box(box, *frames[link]) for link, box in MODEL.shapes.items()}


def touch(a: Placed, b: Placed) -> bool:
    """Whether two boxes overlap in any pose: there is no separating axis."""
    (axes_a, at_a, half_a), (axes_b, at_b, half_b) = a, b
    way = at_b - at_a
    near = np.linalg.norm(way, axis=1) <= np.linalg.norm(half_a) + np.linalg.norm(half_b)  # of the spheres around them
    if not near.any():
        return False
    turned = [(axes[near] if len(axes) > 1 else axes, half) for axes, half in ((axes_a, half_a), (axes_b, half_b))]
    first, second = (np.broadcast_to(axes, (near.sum(), 3, 3)).swapaxes(1, 2) for axes, _ in turned)  # axes as rows
    crossed = np.cross(first[:, :, None], second[:, None]).reshape(-1, 9, 3)
    tried = np.concatenate([first, second, crossed], axis=1)  # N x 15 x 3
    size = sum(np.abs(tried @ axes) @ half for axes, half in turned)
    apart = (np.abs(tried @ way[near, :, None])[..., 0] > size + 1e-9).any(axis=1)
    return not apart.all()


def touches_surface(box: Placed, corners: Array) -> bool:
    """Whether a box and triangles (M x 3 x 3) overlap in any pose: there is no separating axis."""
    axes, at, half = box
    middle = corners.reshape(-1, 3).mean(axis=0)
    radius = np.linalg.norm(corners.reshape(-1, 3) - middle, axis=1).max() + np.linalg.norm(half)
    near = np.linalg.norm(at - middle, axis=1) <= radius
    if not near.any():
        return False
    seen = np.einsum("nki,nmvk->nmvi", axes[near], corners[None] - at[near][:, None, None])  # from the box
    edges = np.roll(seen, -1, axis=2) - seen
    units = np.broadcast_to(np.eye(3), (*edges.shape[:2], 3, 3))
    normal = np.cross(edges[:, :, 0], edges[:, :, 1])[:, :, None]
    crossed = [np.cross(edges[:, :, i, None], units) for i in range(3)]
    tried = np.concatenate([units, normal, *crossed], axis=2)  # N x M x 13 x 3
    along = np.einsum("nmai,nmvi->nmav", tried, seen)
    size = np.abs(tried) @ half
    apart = ((along.min(axis=3) > size + 1e-9) | (along.max(axis=3) < -size - 1e-9)).any(axis=2)
    return not apart.all()


def touched(scene: Scene, poses: Array) -> Iterator[tuple[str, str]]:
    found = bodies(poses)
    pairs = [(a, b, found[b]) for a, b in OWN]
    for one in scene.obstacles:
        if one.mesh is None:
            fixed = of_box(one.box, one.place[None, :3, :3], one.place[None, :3, 3])
            pairs += [(link, str(one.name), fixed) for link in ARM]
    yield from ((a, b) for a, b, other in pairs if touch(found[a], other))
    for one in scene.obstacles:
        if one.mesh is not None:
            corners = one.mesh.vertices[one.mesh.faces] @ one.place[:3, :3].T + one.place[:3, 3]
            yield from ((link, str(one.name)) for link in ARM if touches_surface(found[link], corners))


def dense(made: Trajectory) -> Array:
    poses = [np.array(made.samples[0].positions)[None]]
    for before, now in pairwise(made.samples):
        a, b = np.array(before.positions), np.array(now.positions)
        count = max(1, math.ceil(np.abs(b - a).max() / DENSE))
        poses.append(a + (b - a) * (np.arange(1, count + 1) / count)[:, None])
    return np.concatenate(poses)


def free_pose(rng: random.Random, scene: Scene) -> Angles:
    """A pose that touches nothing and stands above the ground, by this implementation."""
    with_ground = Scene((*scene.obstacles, Obstacle(PartOf("ground", "site"), GROUND, np.eye(4))))
    while any(touched(with_ground, np.array([(*(pose := random_pose(rng)), 0.0)]))):
        pass
    return pose


def beyond_limits(made: Trajectory) -> list[str]:
    found = []
    for index, (name, joint) in enumerate(MODEL.joints.items()):
        positions, speeds, forces = (
            np.array([getattr(sample, what)[index] for sample in made.samples])
            for what in ("positions", "velocities", "accelerations")
        )
        jerks = np.diff(forces) / np.diff([sample.time for sample in made.samples])
        inside = (positions >= (joint.min or -math.inf) - 1e-6) & (positions <= (joint.max or math.inf) + 1e-6)
        small = [
            inside.all(), np.abs(speeds).max() <= joint.velocity * 1.000001,
            np.abs(forces).max() <= joint.acceleration * 1.000001, np.abs(jerks).max() <= joint.jerk * 1.001,
        ]  # fmt: skip
        found += [name] * (not all(small))
    return found


@pytest.mark.turns
@pytest.mark.timeout(3600)  # `make nightly` looks at 5,000
@settings(max_examples=SCENES)
@example(17317)  # it begins a few centimetres beside a box
@given(st.integers(0, 10**9))
def test_no_way_touches_anything_or_leaves_the_limits(seed: int) -> None:
    rng, more = random.Random(seed), random.Random(seed + 1)
    heaps = tuple(random_heap(more, number) for number in range(more.choice((0, 0, 1, 2))))
    scene = random_scene(rng)
    scene = Scene((*scene.obstacles, *heaps))
    now, target = free_pose(rng, scene), free_pose(rng, scene)
    try:
        found = WAYS.plan(now, Moves((target,)), scene)
    except SubtaskFailed as error:
        assert isinstance(error.reason, (Collision, NoWayRound))
        return
    made, notes = found.made, found.notes
    around = Obstacle(PartOf("ground", "site"), GROUND, np.eye(4))
    assert list(touched(Scene((*scene.obstacles, around)) if notes else scene, dense(made))) == []
    assert beyond_limits(made) == []
    assert made.samples[0].positions[:4] == now
    assert np.cos(np.array(made.samples[-1].positions[:4]) - target).min() > 1 - 1e-9
