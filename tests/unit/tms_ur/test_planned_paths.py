"""The ways that navigations tell, as they are drawn."""

import math
from itertools import pairwise

import pytest
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path

from tms_ur.planned_paths import AS_GOOD, MOST, MOST_POSES, drawn


def told(places: list[tuple[float, float]], frame: str = "map") -> Path:
    path = Path(poses=[PoseStamped() for _ in places])
    path.header.frame_id = frame
    for pose, (x, y) in zip(path.poses, places, strict=True):
        pose.pose.position.x, pose.pose.position.y = x, y
    return path


def test_a_straight_way_is_its_ends() -> None:
    assert drawn(told([(0.1 * i, 0.0) for i in range(101)])) == [(0.0, 0.0), (10.0, 0.0)]


def test_a_curve_is_drawn_about_as_it_is() -> None:
    arc = [(5 * math.cos(a), 5 * math.sin(a)) for a in (0.01 * i for i in range(158))]
    found = drawn(told(arc))
    assert 3 < len(found) < 20 and (found[0], found[-1]) == ((5.0, 0.0), (round(arc[-1][0], 2), 5.0))
    middles = [((x + u) / 2, (y + v) / 2) for (x, y), (u, v) in pairwise(found)]
    assert all(5.0 - math.hypot(*one) < AS_GOOD + 0.02 for one in middles)


def test_a_way_of_many_bends_is_drawn_with_few_places() -> None:
    zigzag = [(float(i), float(i % 2)) for i in range(5000)]
    found = drawn(told(zigzag))
    assert len(found) <= MOST and (found[0], found[-1]) == (zigzag[0], zigzag[-1])


@pytest.mark.parametrize(
    "path",
    [
        told([]), told([(0.0, 0.0)]), told([(0.0, 0.0), (1.0, 1.0)], "odom"), told([(0.0, 0.0), (math.nan, 1.0)]),
        told([(float(i), 0.0) for i in range(MOST_POSES + 1)]),
    ],
    ids=["nothing", "one place", "another frame", "no number", "too long"],
)  # fmt: skip
def test_what_is_no_way_is_not_drawn(path: Path) -> None:
    assert drawn(path) == []
