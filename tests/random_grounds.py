"""Sites for tracks, from a seed: machines and areas on 100 m x 100 m, and poses among them."""

import math
import random

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.from_above import from_above
from tms_control.ground import Body, Ground
from tms_control.path import Pose
from tms_control.reasons import BlockedArea, MachineThere

SIDE = 100.0  # m
MODELS = tuple(parse(CONFIGS / "machines" / f"{name}.yaml", MachineModel) for name in ("ic120", "zx200", "mst110cr"))


def random_ground(rng: random.Random, machines: int, areas: int = 0) -> Ground:
    found = []
    for number in range(machines):
        model, place = rng.choice(MODELS), random_pose(rng)
        grown = rng.choice((0.0, 0.0, rng.uniform(0, 2)))
        found += [Body.of(MachineThere(f"m{number}"), part, place, grown) for part in from_above(model).values()]
    return Ground((*found, *(random_area(rng, number) for number in range(areas))))


def random_pose(rng: random.Random) -> Pose:
    return Pose(rng.uniform(0, SIDE), rng.uniform(0, SIDE), rng.uniform(-math.pi, math.pi))


def random_area(rng: random.Random, number: int) -> Body:
    """A star of some corners around a place: often bent inwards."""
    x, y, _ = random_pose(rng)
    turns = sorted(rng.uniform(0, math.tau) for _ in range(rng.randint(3, 9)))
    corners = tuple((x + away * math.cos(turn), y + away * math.sin(turn))
                    for turn in turns for away in (rng.uniform(1, 12),))  # fmt: skip
    return Body(BlockedArea(f"area_{number}"), corners)
