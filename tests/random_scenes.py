"""Scenes around an excavator, and poses of its arm, from a seed: boxes stand or hang around it, some below a roof."""

import math
import random

import numpy as np

from tms_config.models import Box
from tms_control.links import placed
from tms_rp.kind import Angles
from tms_rp.meshes import cone, cylinder
from tms_rp.reasons import PartOf, Told
from tms_rp.scene import Obstacle, Scene


def random_box(rng: random.Random, number: int) -> Obstacle:
    away, turn = rng.uniform(4.5, 9), rng.uniform(-math.pi, math.pi)
    x, y, z = rng.uniform(0.2, 1.5), rng.uniform(0.2, 2), rng.choice((0, 0, rng.uniform(2.5, 5)))
    box = Box(min=(-x, -y, z), max=(x, y, z + rng.uniform(1, 6)))
    return Obstacle(PartOf(f"box_{number}", "site"), box, placed(away * math.cos(turn), away * math.sin(turn), turn))


def random_scene(rng: random.Random) -> Scene:
    boxes = tuple(random_box(rng, number) for number in range(rng.randint(1, 5)))
    if rng.random() < 0.5:
        return Scene(boxes)
    height = rng.uniform(5.5, 6.5)
    roof = Box(min=(-12.0, -12.0, height), max=(12.0, 12.0, height + 0.3))
    return Scene((*boxes, Obstacle(PartOf("roof", "site"), roof, np.eye(4))))


def random_heap(rng: random.Random, number: int) -> Obstacle:
    """A heap of soil or a round tank beside the machine, as a surface of triangles."""
    away, turn, height = rng.uniform(5, 9), rng.uniform(-math.pi, math.pi), rng.uniform(0.5, 3)
    mesh = rng.choice((cone, cylinder))(height, rng.uniform(0.5, 2.5))
    place = placed(away * math.cos(turn), away * math.sin(turn), turn)
    place[2, 3] = height / 2
    return Obstacle(Told(f"heap_{number}"), mesh.box, place, mesh=mesh)


def random_pose(rng: random.Random) -> Angles:
    """Swing, boom, arm and bucket [rad], within the limits of a zx200; it may touch something."""
    return rng.uniform(-3, 3), rng.uniform(-1.1, -0.1), rng.uniform(0.6, 2.6), rng.uniform(-0.6, 2.3)
