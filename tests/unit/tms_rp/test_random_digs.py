"""Random records dig and load within all limits and touch only soil, with the bucket, by a second implementation.

It shares no code with the planner's collision check: see test_ways_in_random_scenes.py.
"""

import math
import random

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from examples import examples
from random_scenes import random_scene
from tms_config.models import Box
from tms_reason.errors import SubtaskFailed
from tms_rp.kinds.backhoe.bucket import TILT, tilt
from tms_rp.kinds.backhoe.digging import excavate, release
from tms_rp.kinds.backhoe.goals import Dig, Emptying, TipGoal
from tms_rp.kinds.backhoe.linkage import ArmAngles
from tms_rp.kinds.backhoe.planner import Backhoe
from tms_rp.plan import Plan
from tms_rp.reasons import Collision, DragCut, NoAngleDigs, NoWayRound, PartOf
from tms_rp.scene import Obstacle, Scene
from tms_rp.trajectory import TrajectorySample
from unit.tms_rp.test_blending import beyond
from unit.tms_rp.test_ways_in_random_scenes import MODEL, WAYS, bodies, dense, free_pose, of_box, touch, touched

BACKHOE = Backhoe(MODEL)
CYCLES = examples(25, 1000)
LATE = [0.0 if one.passive else MODEL.response[name].dead_time + MODEL.response[name].lag
        for name, one in MODEL.joints.items()]  # fmt: skip


def random_dig(rng: random.Random) -> Dig:
    away, turn = rng.uniform(4.5, 8.5), rng.uniform(-math.pi, math.pi)
    at = TipGoal(away * math.cos(turn), away * math.sin(turn), rng.uniform(-0.3, 0.3), rng.uniform(1.0, 2.2))
    return Dig(at, rng.uniform(0.2, 1.0), rng.uniform(0.0, 2.5), rng.uniform(0.2, 1.0))


def angles(sample: TrajectorySample) -> ArmAngles:
    return ArmAngles(*sample.positions[:4])


def in_the_ground(poses: np.ndarray, link: str, top: float) -> np.ndarray:
    """In which poses a corner of a link's box is below a height."""
    axes, at, half = bodies(poses)[link]
    return at[:, 2] - (np.abs(axes[:, 2, :]) * half).sum(axis=1) < top - 1e-6


def check_touch(plan: Plan, scene: Scene, top: float | None) -> None:
    made = plan.made
    assert beyond(made) == []
    for driven in (made, made.lagging([late - min(filter(None, LATE)) if late else 0.0 for late in LATE])):
        poses = dense(driven)
        assert list(touched(scene, poses)) == []
        for link in ("boom_link", "arm_link"):
            assert not in_the_ground(poses, link, min(0.0, top or 0.0)).any()
        deep = in_the_ground(poses, "bucket_link", 0.0)
        assert top is not None or not deep.any()
        assert not deep.any() or np.ptp(poses[deep, 0]) < 0.1  # at one angle of the upper body


@pytest.mark.turns
@pytest.mark.timeout(3600)  # `make nightly` looks at 1,000
@settings(max_examples=CYCLES)
@given(st.integers(0, 10**9))
@example(14252)  # just over the ground at the start, a bucket that opened before the boom had lifted went 0.2 m in
def test_a_cycle_touches_nothing_but_the_soil_with_the_bucket(seed: int) -> None:
    rng = random.Random(seed)
    scene = random_scene(rng) if rng.random() < 0.7 else Scene()
    now, goal = ArmAngles(*free_pose(rng, scene)), random_dig(rng)
    try:
        moves = excavate(BACKHOE, now, goal)
        plan = WAYS.plan(now, moves, scene)
        check_touch(plan, scene, goal.at.z)
        assert plan.made.samples[0].positions[:4] == now
        now = angles(plan.made.samples[-1])
        turn = rng.uniform(-math.pi, math.pi)
        over = TipGoal(5.5 * math.cos(turn), 5.5 * math.sin(turn), rng.uniform(3.0, 4.5), 3.0)
        there = WAYS.plan(now, release(BACKHOE, now, Emptying(-0.3, over)), scene)
    except SubtaskFailed as error:
        assert isinstance(error.reason, (Collision, NoWayRound, NoAngleDigs)), error
        return
    check_touch(there, scene, None)
    tilted = [pose for pose in map(angles, there.made.samples) if abs(tilt(pose)) > TILT + 0.05]
    assert all(abs(pose.swing - tilted[-1].swing) < 0.1 for pose in tilted)  # it opens over the place
    wanted = goal.drag if not (cut := [note for note in moves.notes if isinstance(note, DragCut)]) else cut[0].drag
    depths = [BACKHOE.linkage.tip(pose).z for pose in map(angles, plan.made.samples)]
    assert min(depths) == pytest.approx(goal.at.z - goal.depth, abs=0.15 if wanted > 1.0 else 0.3)


def test_the_second_implementation_knows_the_ground() -> None:
    low = np.array([(0.0, -0.1, 1.5, 0.5, 0.0)])
    ground = Obstacle(PartOf("ground", "site"), Box(min=(-20.0, -20.0, -3.0), max=(20.0, 20.0, 0.0)), np.eye(4))
    placed = of_box(ground.box, ground.place[None, :3, :3], ground.place[None, :3, 3])
    assert in_the_ground(low, "bucket_link", 0.0).all() and touch(bodies(low)["bucket_link"], placed)
    assert not in_the_ground(low, "boom_link", 0.0).any()
