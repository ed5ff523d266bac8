"""Gaps between a machine and what stands on the ground, against a second implementation that goes point by point."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.from_above import arm_from_above, from_above, hull
from tms_control.ground import Body, Ground, Outline
from tms_control.links import Links
from tms_control.path import Pose
from tms_reason.reason import Foreign

TRUCK = Outline.rectangle(2.0, -3.6, 1.8, -1.35)
DIGGER = Outline.of(parse(CONFIGS / "machines" / "zx200.yaml", MachineModel))
L_SHAPE = ((10.0, 0.0), (16.0, 0.0), (16.0, 2.0), (12.0, 2.0), (12.0, 8.0), (10.0, 8.0))
FINE = 0.05  # m between the points of the second implementation

place, heading = st.floats(-15, 30), st.floats(-math.pi, math.pi)
poses = st.builds(Pose, place, place, heading)


def body(*corners: tuple[float, float]) -> Body:
    return Body(Foreign("pit"), corners)


def border(outline: Outline, pose: Pose) -> np.ndarray:
    """Points on the border of the machine, close together."""
    return points([spot(pose, *corner) for corner in outline.polygon])


def spot(pose: Pose, x: float, y: float) -> tuple[float, float]:
    c, s = math.cos(pose.yaw), math.sin(pose.yaw)
    return pose.x + c * x - s * y, pose.y + s * x + c * y


def points(corners: list[tuple[float, float]]) -> np.ndarray:
    found = []
    for (x0, y0), (x1, y1) in pairwise([*corners, corners[0]]):
        count = max(1, math.ceil(math.hypot(x1 - x0, y1 - y0) / FINE))
        found += [(x0 + (x1 - x0) * i / count, y0 + (y1 - y0) * i / count) for i in range(count)]
    return np.array(found)


def turns_round(place: tuple[float, float], line: np.ndarray) -> bool:
    """Whether a line goes round a place, by the sum of its angles."""
    angles = np.unwrap(np.arctan2(*(line - place).T[::-1]))
    last = math.atan2(*reversed(line[0] - place))
    return abs(angles[-1] + math.remainder(last - angles[-1], math.tau) - angles[0]) > math.pi


def gap(outline: Outline, pose: Pose, corners: tuple[tuple[float, float], ...]) -> float:
    mine, its = border(outline, pose), points(list(corners))
    if turns_round(tuple(its[0]), mine) or turns_round(tuple(mine[0]), its):
        return 0.0
    return float(np.hypot(*(mine[:, None] - its[None]).T).min())


@pytest.mark.parametrize("outline", [TRUCK, DIGGER])
@pytest.mark.parametrize("corners", [L_SHAPE, L_SHAPE[::-1], ((12.0, 5.0), (12.1, 5.0), (12.0, 5.1))])
@given(poses)
def test_gaps(corners: tuple[tuple[float, float], ...], outline: Outline, pose: Pose) -> None:
    (found,) = body(*corners).gaps(outline, np.array([pose]))
    expected = gap(outline, pose, corners)
    assert found == pytest.approx(expected, abs=1.5 * FINE)


def test_all_poses_are_looked_at_at_once() -> None:
    many = np.array([Pose(x, 1.0, 0.3 * x) for x in range(-5, 25)])
    together = body(*L_SHAPE).gaps(TRUCK, many)
    assert together == pytest.approx([body(*L_SHAPE).gaps(TRUCK, many[i : i + 1])[0] for i in range(len(many))])
    assert 0 < (together == 0).sum() < len(many)


def test_inside_a_large_area_and_around_a_small_one_is_contact() -> None:
    yard = body((-50, -50), (50, -50), (50, 50), (-50, 50))
    post = body((0.1, 0.1), (0.2, 0.1), (0.1, 0.2))
    ahead = Outline.rectangle(5.0, 3.0, 1.0, -1.0)  # the place of its pose is not in it
    assert yard.gaps(ahead, np.array([Pose(0, 0, 0)])) == [0.0]
    assert post.gaps(TRUCK, np.array([Pose(0, 0, 1.0)])) == [0.0]
    assert body((-1, -1), (1, -1), (1, 1), (-1, 1)).gaps(ahead, np.array([Pose(0, 0, 0)])) == pytest.approx([2.0])


@pytest.mark.parametrize("x", [-3.0, -1.5, 1.5])
def test_a_thin_wall_through_the_machine_is_contact(x: float) -> None:
    wall = body((x, -9), (x + 0.1, -9), (x + 0.1, 9), (x, 9))
    assert wall.gaps(TRUCK, np.array([Pose(0, 0, 0), Pose(6, 0, 0)])) == pytest.approx([0.0, 6 - 3.6 - x - 0.1])


@given(st.lists(poses, min_size=1, max_size=5), st.floats(0, 3))
def test_nearer_is_what_gaps_say(many: list[Pose], needed: float) -> None:
    bodies = (body(*L_SHAPE), body((0, 0), (1, 0), (0, 1)))
    found = Ground(bodies).nearer(TRUCK, np.array(many), np.array([needed, needed]))
    assert (found == np.array([one.gaps(TRUCK, np.array(many)) < needed for one in bodies]).T).all()


def test_a_footprint_stands_where_its_machine_does() -> None:
    part = ((-1.0, -2.0), (3.0, -2.0), (3.0, 2.0), (-1.0, 2.0))
    found = Body.of(Foreign("truck"), part, Pose(10.0, 5.0, math.pi / 2), 0.0)
    assert np.array(sorted(found.corners)) == pytest.approx(np.array([(8, 4), (8, 8), (12, 4), (12, 8)]))


def test_an_outline_is_around_all_parts_and_seen_from_a_pivot() -> None:
    truck = Outline.of(parse(CONFIGS / "machines" / "ic120.yaml", MachineModel))
    assert set(truck.polygon) >= {(-3.6, -1.283), (-3.6, 1.317), (2.0, -1.35), (2.0, 1.8)}
    assert truck.seen_from(-0.5).corners == pytest.approx(truck.corners + np.array([0.5, 0.0]))
    assert TRUCK.offsets == pytest.approx([1.35, 2.0, 1.8, 3.6])


def test_an_upper_body_that_turns_is_a_circle() -> None:
    model = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
    tracks, body = from_above(model).values()
    assert len(tracks) == 4 and len(body) == 16
    assert DIGGER.half < 3.4 and DIGGER.reach < 3.6
    tail = [math.hypot(x - 0.10787, y + 0.034301) for x, y in body]
    assert [min(tail), max(tail)] == pytest.approx([3.2656 / math.cos(math.pi / 16)] * 2, abs=0.001)


@given(st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), min_size=3))
def test_a_hull_is_around_all_and_turns_to_the_left(places: list[tuple[float, float]]) -> None:
    found = hull(places)
    round_it = zip(found, (*found[1:], *found[:1]), (*found[2:], *found[:2]), strict=True)
    turns = [(bx - ax) * (cy - by) - (by - ay) * (cx - bx) for (ax, ay), (bx, by), (cx, cy) in round_it]
    assert all(turn > 0 for turn in turns) or len(found) <= 2
    for x, y in places:
        assert len(found) <= 2 or all((bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0
                                      for (ax, ay), (bx, by) in pairwise([*found, found[0]]))  # fmt: skip


def test_without_a_footprint_a_machine_is_a_spot() -> None:
    model = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel).model_copy(update={"footprint": {}})
    assert Outline.of(model).reach < 0.02


@pytest.mark.parametrize("swing", [0.0, 0.5, -math.pi / 2])
def test_an_arm_is_where_its_joints_turn_it(swing: float) -> None:
    model = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
    angles = {**dict.fromkeys(model.joints, 0.0), "boom_joint": -0.8, "arm_joint": 2.0, "bucket_joint": 0.8}
    corners = np.array(arm_from_above(model, Links(model), {**angles, "swing_joint": swing}))
    c, s = math.cos(swing), math.sin(swing)
    ahead = np.array(arm_from_above(model, Links(model), angles))
    axis = np.array(model.geometry["swing_joint"].xyz[:2])
    assert corners == pytest.approx((ahead - axis) @ np.array([[c, s], [-s, c]]) + axis)
    assert 5.0 < ahead[:, 0].max() < 10.0 and np.abs(ahead[:, 1]).max() < 1.0
    around = DIGGER.with_arm(map(tuple, corners))
    assert around is not None and set(around.polygon) <= {*DIGGER.polygon, *map(tuple, corners)}
    assert around.reach == pytest.approx(np.hypot(*corners.T).max())


def test_an_arm_that_is_over_the_machine_makes_it_no_larger() -> None:
    assert TRUCK.with_arm([(1.0, 1.0), (-3.6, 1.8)]) is None
