"""Gaps between a machine and what stands on the ground, against a second implementation that goes point by point."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_config.models import Box
from tms_control.ground import Body, Ground, Outline
from tms_control.path import Pose
from tms_reason.reason import Foreign

TRUCK = Outline(2.0, -3.6, 1.8, -1.35)
L_SHAPE = ((10.0, 0.0), (16.0, 0.0), (16.0, 2.0), (12.0, 2.0), (12.0, 8.0), (10.0, 8.0))
FINE = 0.05  # m between the points of the second implementation

place, heading = st.floats(-15, 30), st.floats(-math.pi, math.pi)
poses = st.builds(Pose, place, place, heading)


def body(*corners: tuple[float, float]) -> Body:
    return Body(Foreign("pit"), corners)


def border(outline: Outline, pose: Pose) -> np.ndarray:
    """Points on the border of the machine, close together."""
    corners = [(outline.front, outline.left), (outline.back, outline.left), (outline.back, outline.right),
               (outline.front, outline.right)]  # fmt: skip
    return points([spot(pose, *corner) for corner in corners])


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


@pytest.mark.parametrize("corners", [L_SHAPE, L_SHAPE[::-1], ((12.0, 5.0), (12.1, 5.0), (12.0, 5.1))])
@given(poses)
def test_gaps(corners: tuple[tuple[float, float], ...], pose: Pose) -> None:
    (found,) = body(*corners).gaps(TRUCK, np.array([pose]))
    expected = gap(TRUCK, pose, corners)
    assert found == pytest.approx(expected, abs=1.5 * FINE)


def test_all_poses_are_looked_at_at_once() -> None:
    many = np.array([Pose(x, 1.0, 0.3 * x) for x in range(-5, 25)])
    together = body(*L_SHAPE).gaps(TRUCK, many)
    assert together == pytest.approx([body(*L_SHAPE).gaps(TRUCK, many[i : i + 1])[0] for i in range(len(many))])
    assert 0 < (together == 0).sum() < len(many)


def test_inside_a_large_area_and_around_a_small_one_is_contact() -> None:
    yard = body((-50, -50), (50, -50), (50, 50), (-50, 50))
    post = body((0.1, 0.1), (0.2, 0.1), (0.1, 0.2))
    ahead = Outline(5.0, 3.0, 1.0, -1.0)  # the place of its pose is not in it
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
    box = Box(min=(-1.0, -2.0, 0.0), max=(3.0, 2.0, 2.0))
    found = Body.of(Foreign("truck"), box, Pose(10.0, 5.0, math.pi / 2), 0.0)
    assert np.array(sorted(found.corners)) == pytest.approx(np.array([(8, 4), (8, 8), (12, 4), (12, 8)]))


def test_an_outline_is_around_all_boxes_and_seen_from_a_pivot() -> None:
    boxes = [Box(min=(-3.6, -1.3, 0.0), max=(0.7, 1.3, 2.9)), Box(min=(0.7, -1.35, 0.0), max=(2.0, 1.8, 3.9))]
    assert Outline.of(boxes) == Outline(2.0, -3.6, 1.8, -1.35)
    assert Outline.of(boxes).seen_from(-0.5) == Outline(2.5, -3.1, 1.8, -1.35)
    assert Outline.of([]) == Outline(0.0, 0.0, 0.0, 0.0)
