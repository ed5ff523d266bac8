"""Ways around what stands on the ground: they keep clear, also by a second implementation, or their refusal says why.

The second implementation knows no rectangles: it asks of points of the machine, close together, whether they lie in a
body, and of the body's corners whether they lie in the machine.
"""

import math
import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from examples import examples
from random_grounds import random_ground, random_pose
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.detour import Question
from tms_control.from_above import from_above
from tms_control.ground import Body, Ground, Outline
from tms_control.path import Path, Piece, Pose
from tms_control.planner import RADIUS, Goal, Pace, Plan, plan
from tms_control.reasons import BlockedArea, GoalTaken, InTheWay, MachineThere, NoWayAround, StandsIn
from tms_control.way_check import CLEAR, STEP
from tms_reason.reason import Reason

PACE = Pace(forward=1.0, turn=0.24)
SIDES = FRONT, BACK, LEFT, RIGHT = 2.0, -3.6, 1.8, -1.35
TRUCK = Outline.rectangle(*SIDES)
SCENES = examples(40, 2000)


def area(name: str, *corners: tuple[float, float], growth: float = 0.0) -> Body:
    return Body(BlockedArea(name), corners, growth)


def box(x0: float, y0: float, x1: float, y1: float, name: str = "pit", growth: float = 0.0) -> Body:
    return area(name, (x0, y0), (x1, y0), (x1, y1), (x0, y1), growth=growth)


def ask(start: Pose, goal: Pose, *bodies: Body, pivot: float = 0.0) -> Plan | Reason:
    return Question(start, (Goal(*goal),), PACE, pivot, TRUCK, Ground(bodies)).answer()


def way(start: Pose, goal: Pose, *bodies: Body, pivot: float = 0.0) -> Path:
    found = ask(start, goal, *bodies, pivot=pivot)
    assert isinstance(found, Plan), found
    assert found.path.pieces[0].start.ahead(-pivot).away(start) < 1e-6
    end = found.path.end.ahead(-pivot)
    assert end.away(goal) < 0.01 and abs(end.off(goal.yaw)) < 0.01
    return found.path


def dense(path: Path, pivot: float = 0.0) -> list[Pose]:
    """Poses of the base 2 cm and 5 mrad apart."""
    found = []
    for piece in path.pieces:
        count = max(1, math.ceil(piece.length / 0.02), math.ceil(abs(piece.turn) / 0.005))
        for i in range(count + 1):
            pose = piece.at(piece.length * i / count) if piece.length else piece.start
            yaw = piece.start.yaw + piece.turn * i / count
            found.append(pose._replace(yaw=yaw).ahead(-pivot))
    return found


def touches(poses: list[Pose], body: Body) -> bool:
    """Whether a border of the machine, grown by nothing, lies in the body, or a corner of the body in the machine."""
    xs = np.linspace(BACK, FRONT, 15)
    ys = np.linspace(RIGHT, LEFT, 9)
    border = np.array([*((x, y) for x in xs for y in (ys[0], ys[-1])), *((x, y) for x in (xs[0], xs[-1]) for y in ys)])
    at, corners = np.array(poses), np.array(body.corners)
    middle = corners.mean(axis=0)
    far = np.hypot(*(corners - middle).T).max() + 10
    at = at[np.hypot(*(at[:, :2] - middle).T) < far]
    c, s = np.cos(at[:, 2, None]), np.sin(at[:, 2, None])
    x = at[:, 0, None] + c * border[:, 0] - s * border[:, 1]
    y = at[:, 1, None] + s * border[:, 0] + c * border[:, 1]
    if in_polygon(x, y, corners).any():
        return True
    dx, dy = corners[:, 0] - at[:, 0, None], corners[:, 1] - at[:, 1, None]
    u, v = c * dx + s * dy, c * dy - s * dx
    return bool(((u > BACK) & (u < FRONT) & (v > RIGHT) & (v < LEFT)).any())


def in_polygon(x: np.ndarray, y: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """By the winding number of the corners round each point."""
    turned = np.zeros(x.shape)
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        a, b = (x0 - x, y0 - y), (x1 - x, y1 - y)
        turned += np.arctan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
    return np.abs(turned) > math.pi


@pytest.mark.turns
@pytest.mark.timeout(3600)
@settings(max_examples=SCENES)
@given(st.integers(0, 10**9), st.sampled_from([0.0, -0.5]))
def test_no_way_touches_anything(seed: int, pivot: float) -> None:
    rng = random.Random(seed)
    ground, start, goal = random_ground(rng, 5, 3), random_pose(rng), random_pose(rng)
    found = Question(start, (Goal(*goal),), PACE, pivot, TRUCK, ground).answer()
    if not isinstance(found, Plan):
        assert isinstance(found, (StandsIn, GoalTaken, NoWayAround))
        return
    poses = dense(found.path, pivot)
    assert not [body.name for body in ground.bodies if touches(poses, body)]
    assert poses[0].away(start) < 1e-6 and poses[-1].away(goal) < 0.01 and abs(poses[-1].off(goal.yaw)) < 0.01
    assert all(abs(piece.curvature) <= 1 / RADIUS + 1e-9 for piece in found.path.pieces)


def test_where_nothing_is_in_the_way_it_is_the_fastest_path() -> None:
    start, goal = Pose(0, 0, 0), Pose(20, 5, 1.0)
    assert way(start, goal, box(0, 20, 5, 30)) == plan(start, [Goal(*goal)], PACE).path
    question = Question(start, (Goal(*goal),), PACE, 0.0, TRUCK, Ground((box(0, 20, 5, 30),)))
    assert question.fastest() == plan(start, [Goal(*goal)], PACE)


def test_around_a_wall_it_keeps_half_a_metre() -> None:
    wall = box(9, -20, 11, 10)
    path = way(Pose(0, 0, 0), Pose(20, 0, 0), wall)
    gaps = wall.gaps(TRUCK, np.array(dense(path)))
    assert CLEAR - STEP / 2 <= gaps.min() < 2.5
    assert PACE.total(path.pieces) < 90


def test_through_a_gap_that_is_a_metre_wider_than_it_has_to_be() -> None:
    width = 3.15 + 2 * CLEAR + 1.0
    walls = box(9, -60, 11, -width / 2), box(9, width / 2, 11, 60)
    path = way(Pose(0, -8, 0.7), Pose(20, 8, 0), *walls)
    assert all(abs(pose.y) < 2.5 for pose in dense(path) if 9 < pose.x < 11)
    width -= 2.0
    walls = box(9, -60, 11, -width / 2), box(9, width / 2, 11, 60)
    assert isinstance(ask(Pose(0, -8, 0.7), Pose(20, 8, 0), *walls), NoWayAround)


def test_it_backs_into_a_bay_that_has_no_room_to_turn() -> None:
    """The truck is to stand in it with its front to the open end."""
    bay = box(20, 2.3, 30, 3.3), box(20, -3.3, 30, -2.3), box(29, -3.3, 30, 3.3)
    path = way(Pose(0, 8, 0.2), Pose(25, 0, math.pi), *bay)
    assert path.pieces[-1].direction == -1 and path.pieces[-1].length >= 4
    assert min(body.gaps(TRUCK, np.array(dense(path))).min() for body in bay) > 0.3


def test_what_stands_near_at_an_end_is_not_come_nearer_to() -> None:
    beside = box(-3, 1.9, 2, 3.9)  # 10 cm to the left of the start
    path = way(Pose(0, 0, 0), Pose(0, 12, math.pi / 2), beside)
    assert beside.gaps(TRUCK, np.array(dense(path))).min() > 0.05


def test_a_machine_that_may_have_moved_is_kept_away_from_but_may_stand_beside_the_start() -> None:
    machine = box(10, -2, 14, 2, growth=3.0)
    path = way(Pose(0, 0, 0), Pose(30, 0, 0), machine)
    assert machine.gaps(TRUCK, np.array(dense(path))).min() > 3.0 + CLEAR - STEP
    assert isinstance(ask(Pose(0, 0, 0), Pose(18, 0, 0), machine), GoalTaken)
    way(Pose(7.5, 0, 0), Pose(-10, 0, 0), machine)  # half a metre before it


@pytest.mark.parametrize(
    ("bodies", "why"),
    [
        ((box(-1, -1, 1, 1),), StandsIn(BlockedArea("pit"))),
        ((box(19, -1, 21, 1),), GoalTaken(BlockedArea("pit"), 0.0, 1e-6)),
    ],
)
def test_a_refusal_names_what_stands_at_the_ends(bodies: tuple[Body, ...], why: Reason) -> None:
    assert ask(Pose(0, 0, 0), Pose(20, 0, 0), *bodies) == why


def test_a_refusal_names_what_blocks_where_and_how_far() -> None:
    ring = [
        box(14, -6, 15, 6, "east"),
        box(-7, -6, -6, 6, "west"),
        box(-7, 5, 15, 6, "north"),
        box(-7, -6, 15, -5, "south"),
    ]
    said = ask(Pose(0, 0, 0), Pose(30, 0, 0), *ring)
    assert isinstance(said, NoWayAround) and said.by == BlockedArea("east")
    assert isinstance(said.why, InTheWay)
    assert (said.why.x, said.why.y, said.why.away) == pytest.approx((11.5, 0.0, 11.5), abs=STEP)


def test_goals_that_are_passed_are_passed_around_what_stands_between() -> None:
    goals = (Goal(20, 0, None), Goal(20, 20, None), Goal(0, 20, math.pi))
    found = Question(Pose(0, 0, 0), goals, PACE, 0.0, TRUCK, Ground((box(9, -3, 11, 3), box(18, 9, 22, 11)))).answer()
    assert isinstance(found, Plan) and len(found.reached) == 3
    for goal, count in zip(goals, found.reached, strict=True):
        assert found.path.pieces[count - 1].end.away(Pose(goal.x, goal.y, 0)) < 0.01
    assert found.reached[-1] == len(found.path.pieces)


def test_the_same_question_has_the_same_answer() -> None:
    ground = random_ground(random.Random(3), 5)
    asked = Question(Pose(5, 5, 0), (Goal(90, 90, 1.0),), PACE, 0.0, TRUCK, ground)
    assert asked.answer() == asked.answer()


ARM = TRUCK.with_arm([(8.0, 0.5), (8.0, -0.5)])


def test_an_arm_is_kept_clear() -> None:
    assert ARM is not None
    pit = box(9, 2.5, 14, 8)
    asked = Question(Pose(0, 0, 0), (Goal(12, 20, math.pi / 2),), PACE, 0.0, TRUCK, Ground((pit,)), ARM)
    without = Question(Pose(0, 0, 0), (Goal(12, 20, math.pi / 2),), PACE, 0.0, TRUCK, Ground((pit,)))
    clear, bare = asked.answer(), without.answer()
    assert isinstance(clear, Plan) and isinstance(bare, Plan)
    assert pit.gaps(ARM, np.array(dense(clear.path))).min() > CLEAR - STEP
    assert pit.gaps(ARM, np.array(dense(bare.path))).min() == 0.0


def test_an_arm_that_no_way_keeps_clear_is_high_enough() -> None:
    over = box(5, -1, 7, 1)  # at the start already
    asked = Question(Pose(0, 0, 0), (Goal(-20, 0, 0.0),), PACE, 0.0, TRUCK, Ground((over,)), ARM)
    without = Question(Pose(0, 0, 0), (Goal(-20, 0, 0.0),), PACE, 0.0, TRUCK, Ground((over,)))
    assert asked.fastest() is None and without.fastest() is not None
    assert asked.answer() == without.answer()


@pytest.mark.parametrize("patience", [0, 3, 40, 400, 4000])
def test_a_search_that_nobody_waits_for_ends(patience: int) -> None:
    """With the next pose, or the next some hundred places, that it would look at."""
    asked = 0

    def over() -> bool:
        nonlocal asked
        asked += 1
        return asked > patience

    ring = [box(x, y, x + 6, y + 6, "ring") for x in range(20, 50, 6) for y in (-15, 15)]
    ring += [box(x, y, x + 6, y + 6, "ring") for x in (20, 44) for y in range(-15, 20, 6)]
    round_one = area("round", *((math.cos(i / 8) * 9, 30 + math.sin(i / 8) * 9) for i in range(50)))
    question = Question(Pose(0, 0, 0), (Goal(35, 0, 0.0),), PACE, 0.0, TRUCK, Ground((*ring, round_one)))
    assert question.answer(over) is None
    assert patience < asked <= patience + 3


def test_a_machine_that_is_there_already_stays() -> None:
    found = ask(Pose(3, 4, 0.5), Pose(3, 4, 0.5))
    assert isinstance(found, Plan) and found.path.pieces == (Piece(Pose(3, 4, 0.5), 0.0, 0.0),)


def test_machines_are_named() -> None:
    truck = Body(MachineThere("ic120_1"), ((19, -1), (21, -1), (21, 1), (19, 1)))
    said = ask(Pose(0, 0, 0), Pose(20, 0, 0), truck)
    assert isinstance(said, GoalTaken) and said.by == MachineThere("ic120_1")


@pytest.mark.parametrize(("x", "y", "yaw"), [(-8.0, -9.0, 0.0), (-12.0, -9.0, 0.0), (-13.85, -9.17, 1.0)])
def test_where_excavators_stand_close_as_in_the_simulators_scene_samples_are_driven_straight(
    x: float, y: float, yaw: float
) -> None:
    """The swing circles of zx200 and zx120 are 37 cm apart there."""
    digger, beside = (parse(CONFIGS / "machines" / f"{name}.yaml", MachineModel) for name in ("zx200", "zx120"))
    there = Pose(*beside.start)
    bodies = tuple(Body.of(MachineThere("zx120"), part, there, 0.0) for part in from_above(beside).values())
    start = Pose(*digger.start)
    question = Question(start, (Goal(x, y, yaw),), PACE, 0.0, Outline.of(digger), Ground(bodies))
    assert question.fastest() == plan(start, [Goal(x, y, yaw)], PACE)
