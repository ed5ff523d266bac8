"""Ways along roads: taken where they help, entered and left where that is best, and changed where they meet."""

import math
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from tms_control.path import Pose
from tms_control.planner import RADIUS
from tms_control.roads import OFF_ROAD, Place, Roads, count

BEND = ((0.0, 0.0), (60.0, 0.0), (60.0, 60.0))
ROADS = Roads((BEND,))
PLACES = st.tuples(st.floats(-80, 80), st.floats(-80, 80))


def passed(roads: Roads, start: Place, goal: Place) -> list[Place]:
    goals = roads.between(Pose(*start, 0.0), Pose(*goal, 0.0))
    assert all(goal.yaw is None for goal in goals)
    return [(goal.x, goal.y) for goal in goals]


def test_a_bend_is_driven_round() -> None:
    way = passed(ROADS, (-5.0, 2.0), (62.0, 65.0))
    assert (60.0, 0.0) in way and way[0][1] == 0.0 and way[-1][0] == 60.0
    assert passed(ROADS, (62.0, 65.0), (-5.0, 2.0)) == way[::-1]


def test_a_road_that_does_not_help_is_left_alone() -> None:
    assert passed(ROADS, (0.0, 30.0), (20.0, 45.0)) == []
    assert passed(Roads(), (0.0, 0.0), (60.0, 60.0)) == []


def test_a_straight_road_is_entered_and_left_and_has_no_places_in_between() -> None:
    way = passed(Roads((((0.0, 0.0), (100.0, 0.0)),)), (10.0, 10.0), (90.0, -10.0))
    assert len(way) == 2 and all(y == 0.0 for _, y in way)
    assert 10.0 <= way[0][0] <= 20.0 and 80.0 <= way[1][0] <= 90.0


def test_from_one_road_to_another() -> None:
    crossing = Roads((((0.0, 0.0), (100.0, 0.0)), ((52.0, -50.0), (52.0, 50.0))))
    way = passed(crossing, (0.0, 1.0), (52.0, 50.0))
    assert all(y == 0.0 or x == 52.0 for x, y in way) and any(x == 52.0 for x, y in way)


def test_nothing_is_passed_so_near_that_it_cannot_be_steered_to() -> None:
    way = passed(ROADS, (30.0, 0.0), (60.0, 30.0))
    assert way == [(60.0, 0.0)]
    assert passed(ROADS, (58.0, 0.0), (60.0, 30.0)) == [(60.0, 5.0)]


def test_places_every_five_metres_count() -> None:
    assert count(ROADS.lines) == 25 and count([((0.0, 0.0), (1.0, 0.0))]) == 2


@given(PLACES, PLACES)
def test_no_way_is_much_longer_than_straight_across(start: Place, goal: Place) -> None:
    way = passed(ROADS, start, goal)
    assert sum(math.dist(*leg) for leg in pairwise([start, *way, goal])) <= OFF_ROAD * math.dist(start, goal) + 1e-6
    assert all(math.dist(place, end) >= RADIUS for place in way for end in (start, goal))
