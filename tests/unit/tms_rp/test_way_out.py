"""Out of an overlap: along the gradient, in few steps, or not at all."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from tms_config.config import CONFIGS
from tms_config.models import Box, MachineModel
from tms_config.yaml_file import parse
from tms_control.links import Array, Links, box_place
from tms_reason.errors import SubtaskFailed
from tms_rp.clearance import Clearance
from tms_rp.kind import Moves
from tms_rp.kinds import load
from tms_rp.reasons import PartOf, SlowlyOut
from tms_rp.scene import Obstacle, Scene
from tms_rp.way_out import STEP, STEPS, way_out
from tms_rp.ways import Ways

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
NOW = (0.0, -0.6, 1.6, 0.8)
FREE = [(-math.inf, math.inf)] * 2


def hill(gradient: Callable[[Array], Array]) -> Callable[[Array], Array]:
    return lambda poses: np.maximum(0.0, np.array([float(gradient(pose)) for pose in poses]))


def test_it_goes_the_steepest_way() -> None:
    out = way_out(hill(lambda q: 0.5 - q[0] - 4 * q[1]), (0.0, 0.0), FREE)
    assert out is not None and out[1] == pytest.approx(4 * out[0]) and 0.5 - out[0] - 4 * out[1] <= 0


@pytest.mark.parametrize(
    "depth", [lambda q: 1.0, lambda q: 0.1 + (q[0] ** 2 + q[1] ** 2), lambda q: 2 * STEP * STEPS - q[0]]
)
def test_where_it_gets_no_less_all_the_way_there_is_none(depth: Callable[[Array], Array]) -> None:
    assert way_out(hill(depth), (0.0, 0.0), FREE) is None


def test_it_stays_inside_the_limits() -> None:
    assert way_out(hill(lambda q: 0.5 - q[0]), (0.0, 0.0), [(-1.0, 0.1), (-1.0, 1.0)]) is None


def box_at_bucket(side: float, deep: float, half: float) -> Scene:
    """A box beside the bucket, so far in it [m]; it lies on the left (side 1) or on the right."""
    place = Links(MODEL).places(np.array([(*NOW, 0.0)]))["bucket_link"][0] @ box_place(MODEL.shapes["bucket_link"])
    low, high = MODEL.shapes["bucket_link"].min[1], MODEL.shapes["bucket_link"].max[1]
    place = place.copy()
    place[:3, 3] += place[:3, 1] * side * ((high - low) / 2 + half - deep)
    return Scene((Obstacle(PartOf("box", "site"), Box(min=(-2.0, -half, -2.0), max=(2.0, half, 2.0)), place),))


@pytest.mark.parametrize("side", [1, -1])
def test_an_arm_comes_out_on_the_side_where_it_is_nearer(side: int) -> None:
    """The goal is on the other side, behind the box: straight on it would go through."""
    scene, target = box_at_bucket(side, 0.15, 0.4), (side * 1.2, *NOW[1:])
    plan = Ways(MODEL, load("backhoe")).plan(NOW, Moves((target,)), scene)
    assert any(isinstance(note, SlowlyOut) for note in plan.notes)
    first = plan.made.stops[0]
    swings = [one.positions[0] for one in plan.made.samples if one.time <= first]
    assert side * swings[-1] < 0 and abs(swings[-1]) < 0.1
    with Clearance(MODEL, padding=0.0).looking(scene) as view:
        assert view.overlap(plan.made.samples[-1].positions) is None
    speed = max(abs(one.velocities[0]) for one in plan.made.samples)
    assert speed <= 0.25 * MODEL.joints["swing_joint"].velocity * 1.001


def test_one_that_is_all_inside_is_refused() -> None:
    around = Box(min=(-12.0, -12.0, -12.0), max=(12.0, 12.0, 12.0))
    with pytest.raises(SubtaskFailed):
        Ways(MODEL, load("backhoe")).plan(
            NOW, Moves(((1.0, *NOW[1:]),)), Scene((Obstacle(PartOf("box", "site"), around, np.eye(4)),))
        )
