"""The ground around an excavator as boxes: near enough to its heights, few, and dug by the bucket alone."""

import math

import numpy as np
import pytest

from earth_rig import model_of
from tms_control.links import placed
from tms_rp.scene import Obstacle, Region, Scene
from tms_rp.terrain import CELL, LEVEL, MOST, Terrain
from tms_rp.trench import Trench
from tms_soil.surface import Array, Heights

TRACKS = model_of("zx200").tracks


def ground(shape) -> Heights:
    z = np.zeros((260, 260))
    found = Heights(-26.0, -26.0, 0.2, z)
    z[:] = shape(*found.centres)
    return found


def heap(x: Array, y: Array) -> Array:
    return np.maximum(0.0, 2.0 - 0.7 * np.hypot(x - 6.0, y - 1.0))


def tops(boxes: tuple[Obstacle, ...], points: Array, lets: str = "") -> Array:
    """Height of the highest box at points of base_link."""
    found = np.full(len(points), -np.inf)
    for one in boxes:
        if one.lets == lets:
            seen = (points - one.place[:3, 3]) @ one.place[:3, :3]
            inside = np.all((seen[:, :2] >= -1e-9) & (seen[:, :2] <= np.array(one.box.max[:2]) + 1e-9), axis=1)
            found[inside] = np.maximum(found[inside], one.place[2, 3])
    return found


def around(count: int = 2000, reach: float = 10.0) -> Array:
    chance = np.random.default_rng(3)
    return np.column_stack((chance.uniform(-reach, reach, (count, 2)), np.zeros(count)))


def test_level_ground_is_one_box() -> None:
    (one,) = Terrain(ground(lambda x, _: 0 * x + 3.5), TRACKS, (2.0, 1.0, 0.7)).whole
    assert one.place[2, 3] == pytest.approx(0.0, abs=1e-9), "where the tracks stand"
    assert tops((one,), around()).max() == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("yaw", [0.0, 1.1, -2.5])
def test_a_heap_is_as_high_as_it_is(yaw: float) -> None:
    told = ground(heap)
    boxes = Terrain(told, TRACKS, (0.0, 0.0, yaw)).whole
    assert 10 < len(boxes) <= MOST
    points = around()
    there = points @ placed(0.0, 0.0, yaw)[:3, :3].T
    off = tops(boxes, points) - told.at(there[:, 0], there[:, 1])
    step = 0.7 * CELL  # the heap's slope over a cell
    assert off.min() > -step and off.mean() < 0.15
    assert off.max() < 5 * LEVEL + step


def test_a_rough_ground_is_coarser_but_not_endless() -> None:
    rough = np.random.default_rng(1).uniform(0.0, 1.0, (260, 260))
    boxes = Terrain(ground(lambda *_: rough), TRACKS, (0.0, 0.0, 0.0)).whole
    assert 0 < len(boxes) <= MOST


def test_a_long_step_across_leaves_the_low_ground_low() -> None:
    told = ground(lambda x, y: np.where(x + y > 6.0, 1.5, 0.0))
    boxes = Terrain(told, TRACKS, (0.0, 0.0, 0.0)).whole
    points = around()
    high, across = tops(boxes, points), points[:, 0] + points[:, 1]
    assert (high[across < 3.5] < 0.1).all() and (high[across > 6.3] > 1.4).all()


def test_a_slope_under_the_tracks_is_level_for_the_machine() -> None:
    boxes = Terrain(ground(lambda x, y: 0.2 * x - 0.1 * y), TRACKS, (3.0, 2.0, 0.5)).whole
    assert len(boxes) == 1 and boxes[0].place[2, 3] == pytest.approx(0.0, abs=0.03)


def test_an_unknown_ground_counts_as_level() -> None:
    told = ground(lambda x, _: np.where(x > 4.0, np.nan, 1.0))
    assert tops(Terrain(told, TRACKS, (0.0, 0.0, 0.0)).whole, around()).max() == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("yaw", [0.0, 0.8])
def test_only_in_the_trench_may_the_tool_be_in_the_ground(yaw: float) -> None:
    scene = Scene(ground=Terrain(ground(heap), TRACKS, (0.0, 0.0, 0.0)))
    trench = Trench(0.1, -0.03, yaw, 1.5, 4.1, 7.3, 0.0, "bucket_link")
    boxes = trench.around(scene).obstacles
    assert {one.lets for one in boxes} == {"", "bucket_link"}
    points = around()
    seen = (points - [0.1, -0.03, 0.0]) @ placed(0.0, 0.0, yaw)[:3, :3]
    out, aside = seen[:, 0], np.abs(seen[:, 1])
    dug = (out > 4.1) & (out < 7.3) & (aside < 0.75)
    beside = (out < 3.8) | (out > 7.5) | (aside > 0.75 + 1e-6)
    for lets, there, elsewhere in (("bucket_link", dug, beside), ("", beside, dug)):
        found = tops(boxes, points, lets)
        assert np.isfinite(found[there]).all() and np.isneginf(found[elsewhere]).all()


def test_digs_at_other_places_are_made_of_the_same_bodies() -> None:
    scene, sizes = Scene(ground=Terrain(ground(heap), TRACKS, (0.0, 0.0, 0.0))), set()
    for k in range(25):
        trench = Trench(0.0, 0.0, 0.1 * k, 1.53, 4.0 + 0.013 * k, 7.0 + 0.017 * k, 0.0, "bucket_link")
        sizes |= {one.box for one in trench.around(scene).obstacles}
    before = len(sizes)
    for k in range(25):
        trench = Trench(0.0, 0.0, 0.1 * k + 0.05, 1.53, 4.0 + 0.011 * k, 7.0 + 0.019 * k, 0.0, "bucket_link")
        sizes |= {one.box for one in trench.around(scene).obstacles}
    assert len(sizes) < 1.5 * before and before < 500


def test_without_a_ground_it_is_flat() -> None:
    (flat,) = Scene().with_ground().obstacles
    assert flat.box.max[2] == 0.0 and Scene().bare() == Scene()
    told = Terrain(ground(heap), TRACKS, (0.0, 0.0, 0.0))
    assert Scene(ground=told).with_ground().obstacles == told.whole
    assert Scene(ground=told).bare().ground is told
    assert math.isclose(told.obstacles(np.eye(4), [Region(1.0, 2.0, -1.0, 1.0)])[0].place[0, 3], 1.0)
