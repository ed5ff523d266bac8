"""Digging and loading are one motion each; what they ask of the arm, and how long they take."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from tms_config.config import CONFIGS
from tms_config.models import Box, MachineModel
from tms_config.yaml_file import parse
from tms_control.links import placed
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.kind import Moves, Through
from tms_rp.kinds import load
from tms_rp.kinds.backhoe.bucket import LEVEL, TILT, tilt
from tms_rp.kinds.backhoe.digging import excavate, release
from tms_rp.kinds.backhoe.goals import ChangePose, Dig, Emptying, TipGoal
from tms_rp.kinds.backhoe.linkage import ArmAngles
from tms_rp.kinds.backhoe.planner import Backhoe
from tms_rp.neighbour import Neighbour, Posture
from tms_rp.plan import Plan
from tms_rp.reasons import Around, ClearanceCut, Collision, DragCut, Ground, OtherAngle, Part, PartOf
from tms_rp.scene import Obstacle, Scene
from tms_rp.trajectory import trajectory
from tms_rp.ways import Ways
from words import words

MODELS = {name: parse(CONFIGS / "machines" / f"{name}.yaml", MachineModel) for name in ("zx200", "zx120", "ic120")}
MODEL = MODELS["zx200"]
BACKHOE, WAYS = Backhoe(MODEL), Ways(MODEL, load("backhoe"))
NOW = ArmAngles(0.0, -0.8029, 1.9897, 0.8029)
SOIL = TipGoal(0.0798115209, -4.7382431030, 0.1016051769, 0.0)
FACE = Dig(TipGoal(6.5, 0.0, 0.0, 1.6), depth=0.5, drag=1.5, lift=0.5)


def dug(goal: Dig = FACE, now: ArmAngles = NOW, scene: Scene | None = None) -> Plan:
    return WAYS.plan(now, excavate(BACKHOE, now, goal), scene or Scene())


def poses(plan: Plan) -> list[ArmAngles]:
    return [ArmAngles(*sample.positions[:4]) for sample in plan.made.samples]


def box(name: str, low: tuple[float, float, float], high: tuple[float, float, float]) -> Scene:
    return Scene((Obstacle(PartOf(name, "site"), Box(min=low, max=high), np.eye(4)),))


# what a dig is


def test_the_nearest_bucket_angle_is_taken_and_told() -> None:
    moves = excavate(BACKHOE, NOW, Dig(SOIL, 1.0, 1.0, 0.5))
    reach = next(target for target in moves.targets if BACKHOE.linkage.tip(ArmAngles(*target)).z < -0.89)
    assert reach == pytest.approx((-1.565542, -0.228449, 2.256313, -0.617864), abs=1.5e-6)
    assert words(moves.notes[0]) == "bucket angle 1.410 rad instead of 0.000 rad"
    assert excavate(BACKHOE, NOW, FACE).notes == ()


def test_a_full_turn_of_theta_w_is_the_same_angle() -> None:
    turned = TipGoal(6.5, 0.0, 0.0, 1.6 + math.tau)
    assert excavate(BACKHOE, NOW, Dig(turned, 0.5, 1.5, 0.5)).targets[-1] == pytest.approx(
        excavate(BACKHOE, NOW, FACE).targets[-1]
    )


def test_it_digs_as_deep_and_drags_as_far_as_it_is_told() -> None:
    plan = dug()
    tips = [BACKHOE.linkage.tip(pose) for pose in poses(plan)]
    deep = [tip.x for tip in tips if tip.z < -0.4]
    assert -0.55 < min(tip.z for tip in tips) < -0.45
    assert max(deep) - min(deep) > 1.3
    longer = [BACKHOE.linkage.tip(pose) for pose in poses(dug(Dig(FACE.at, 0.3, 2.5, 0.5)))]
    deep = [tip.x for tip in longer if tip.z < -0.2]
    assert min(tip.z for tip in longer) == pytest.approx(-0.3, abs=0.06) and max(deep) - min(deep) > 2.2


def test_a_bucket_that_points_outward_turns_down_in_the_drag_and_curls_no_deeper() -> None:
    flat = Dig(TipGoal(7.0, 0.0, 0.0, 1.15), depth=0.5, drag=1.5, lift=0.5)
    assert min(BACKHOE.linkage.tip(pose).z for pose in poses(dug(flat))) > -0.58


def test_the_offset_is_along_the_line_from_base_link() -> None:
    moves = excavate(BACKHOE, NOW, Dig(TipGoal(3.3, 4.4, 0.0, 1.6, offset=1.0), 0.5, 0.0, 0.5))
    assert BACKHOE.linkage.tip(ArmAngles(*moves.targets[1]))[:3] == pytest.approx((3.9, 5.2, -0.5))


def test_a_drag_that_the_arm_cannot_make_is_cut_and_told() -> None:
    moves = excavate(BACKHOE, NOW, Dig(FACE.at, 0.5, 6.0, 0.5))
    (note,) = moves.notes
    assert isinstance(note, DragCut) and note.wanted == 6.0 and 1.0 < note.drag < 5.0


def test_it_ends_level_and_above_the_ground_with_the_soil() -> None:
    for goal in (FACE, Dig(SOIL, 1.0, 1.0, 0.5), Dig(FACE.at, 0.5, 1.5, 1.5)):
        last = ArmAngles(*dug(goal).made.samples[-1].positions[:4])
        assert tilt(last) == pytest.approx(0.0, abs=1e-6)
        assert goal.lift + goal.at.z - 0.01 <= BACKHOE.bucket.lowest(last) <= goal.lift + goal.at.z + 0.2


def test_a_bucket_so_flat_that_the_arm_would_be_in_the_soil_is_turned() -> None:
    moves = excavate(BACKHOE, NOW, Dig(TipGoal(6.0, 0.0, 0.0, 2.9), 1.0, 0.0, 0.5))
    (note,) = moves.notes
    assert isinstance(note, OtherAngle) and note.chosen < 2.8
    assert min(BACKHOE.arm.lowest(ArmAngles(*target)) for target in moves.targets) > 0.1


def test_nothing_but_the_bucket_may_be_in_the_ground_and_that_only_in_its_plane() -> None:
    moves, flat = excavate(BACKHOE, NOW, FACE), ArmAngles(0.014, -0.1, 2.3, -0.3)
    deeper = [*moves.targets[:2], *(flat for _ in moves.targets[2:-2]), *moves.targets[-2:]]
    beside = [(swing + 0.2 * n, *rest) for n, (swing, *rest) in enumerate(moves.targets)]
    for targets, first in ((deeper, "arm_link"), (beside, "bucket_link")):
        with pytest.raises(SubtaskFailed) as caught:
            WAYS.plan(NOW, replace(moves, targets=tuple(targets)), Scene())
        said = caught.value.reason.find(Collision)
        assert said is not None and said.first == Part(first) and said.second == Ground() and said.depth > 0


def test_a_dig_keeps_the_padding_of_its_scene() -> None:
    trench = (excavate(BACKHOE, NOW, FACE).through or Through(())).trench
    padded = Scene(padding=(("bucket_link", 0.3),))
    assert trench is not None and trench.around(padded).padding == padded.padding


def refusal(goal: Dig, scene: Scene | None = None, now: ArmAngles = NOW) -> Reason:
    with pytest.raises(SubtaskFailed) as caught:
        dug(goal, now, scene)
    return caught.value.reason


# the motion


def test_it_comes_to_rest_at_its_end_alone() -> None:
    made = dug().made
    inner = [sample for sample in made.samples if 0.5 < sample.time < made.duration - 0.5]
    assert min(max(map(abs, sample.velocities)) for sample in inner) > 0.02


def test_it_takes_less_time_than_with_stops() -> None:
    moves = excavate(BACKHOE, NOW, FACE)
    with_stops = trajectory(MODEL.joints, (*NOW, 0.0), [(*target, 0.0) for target in moves.targets])
    assert dug().made.duration < 0.7 * with_stops.duration


def test_through_the_soil_it_goes_at_the_speed_of_digging() -> None:
    plan = dug()
    begin, end = plan.reached[0] + 0.6, plan.reached[-3] - 0.6  # where nothing is rounded
    tips = [(one.time, BACKHOE.linkage.tip(ArmAngles(*one.positions[:4]))[:3])
            for one in plan.made.samples if begin <= one.time <= end]  # fmt: skip
    speeds = [math.dist(a, b) / (later - at) for (at, a), (later, b) in pairwise(tips)]
    assert max(speeds) < 0.75 and np.mean(speeds) == pytest.approx(0.6, abs=0.1)


def test_out_of_the_ground_it_does_not_plough() -> None:
    inside = ArmAngles(-1.566, -0.228, 2.256, -0.618)  # a metre in the soil
    for pose in poses(dug(now=inside)):
        if BACKHOE.bucket.lowest(pose) < 0.0 and pose.swing < -0.2:
            assert abs(pose.swing - inside.swing) < 0.05


def test_from_close_above_the_ground_it_does_not_dip_into_it() -> None:
    """Of what only the padding touches at the start, a contact that lasts would be no contact."""
    low = ArmAngles(0.20, -0.441, 2.32, 0.018)
    assert 0.0 < BACKHOE.bucket.lowest(low) < 0.1
    plan = dug(Dig(TipGoal(6.1, 5.2, 0.2, 1.9), 0.6, 1.0, 0.3), now=low)
    entry = next(i for i, pose in enumerate(poses(plan)) if pose.swing > 0.65)
    assert min(BACKHOE.bucket.lowest(pose) for pose in poses(plan)[:entry]) > 0.05


def test_what_is_in_the_way_of_the_swing_is_passed_and_what_is_in_the_pit_refuses_at_once() -> None:
    beside = ArmAngles(-1.6, *NOW[1:])
    crate = box("crate", (3.0, -5.5, 0.0), (5.5, -3.0, 2.4))
    plan = dug(now=beside, scene=crate)
    assert any(isinstance(note, Around) for note in plan.notes)
    pipe = refusal(FACE, box("pipe", (5.5, -3.0, -0.6), (5.8, 3.0, -0.3)))
    assert isinstance(pipe, Collision) and pipe.second == PartOf("pipe", "site") and pipe.first == Part("bucket_link")
    assert pipe.depth > 0 and 5.0 < pipe.x < 6.3
    far = NOW._replace(swing=-2.5)  # the time is that of the whole motion
    later = refusal(FACE, box("pipe", (5.5, -3.0, -0.6), (5.8, 3.0, -0.3)), far)
    assert isinstance(later, Collision) and later.seconds > dug(now=far).reached[0] > 5.0


def test_blocked_in_the_middle_of_a_dig_the_rest_is_planned_from_there() -> None:
    plan = dug()
    lowest = min(range(len(poses(plan))), key=lambda i: BACKHOE.linkage.tip(poses(plan)[i]).z)
    middle = plan.made.samples[lowest + 10]
    rest = plan.rest(middle.time)
    assert rest is not None and 1 <= len(rest.targets) < len(plan.moves.targets)
    assert rest.through is not None and not rest.through.free  # no way around leads on from in there
    before = plan.rest(plan.reached[0] - 0.1)
    assert before is not None and before.through is not None and before.through.free
    again = WAYS.plan(middle.positions[:4], rest, Scene())
    assert again.made.samples[-1].positions == pytest.approx(plan.made.samples[-1].positions)
    assert max(pose.swing for pose in poses(again)) - min(pose.swing for pose in poses(again)) < 0.05
    with pytest.raises(SubtaskFailed):
        WAYS.plan(middle.positions[:4], rest, box("truck", (3.0, -1.0, 0.6), (9.0, 1.0, 3.0)))


# emptying


def test_release_where_it_is_opens_and_comes_up() -> None:
    now = ArmAngles(-0.0028, -0.837315, 1.646905, 2.190410)
    (end,) = map(ArmAngles._make, release(BACKHOE, now, Emptying(-0.34)).targets)
    assert BACKHOE.linkage.tip(end)[:3] == pytest.approx((6.969, -0.106, 4.045), abs=1e-3)
    assert end.swing == now.swing
    pin = [BACKHOE.linkage.tip(pose).z + 1.562 * math.sin(BACKHOE.linkage.tip(pose).theta_w)
           for pose in poses(WAYS.plan(now, release(BACKHOE, now, Emptying(-0.34)), Scene()))]  # fmt: skip
    assert all(b >= a - 1e-6 for a, b in pairwise(pin))  # it rises as the bucket opens


@pytest.mark.parametrize("ground", [0.0, 0.1, 0.3])
def test_an_opening_bucket_does_not_touch_the_ground_that_it_has_dug(ground: float) -> None:
    """It hangs lower than a curled one, so the boom comes up first where a small machine holds it."""
    arm, ways = Backhoe(MODELS["zx120"]), Ways(MODELS["zx120"], load("backhoe"))
    now = ArmAngles(0.0, -0.6, 2.0, 0.8)
    lifted = poses(ways.plan(now, excavate(arm, now, Dig(TipGoal(4.0, 0.0, ground, 1.6), 1.0, 1.0, 0.5)), Scene()))[-1]
    opening = poses(ways.plan(lifted, release(arm, lifted, Emptying(-0.34)), Scene()))
    assert min(map(arm.bucket.lowest, opening)) > 0.05
    assert opening[-1].bucket == pytest.approx(-0.34, abs=1e-3)


def test_release_cuts_the_clearance_at_the_limits() -> None:
    moves = release(BACKHOE, ArmAngles(0.0, -1.1, 2.6, 1.7), Emptying(-0.34))
    assert moves.targets[0][1:3] == (-1.137, 2.687)
    assert moves.notes == (ClearanceCut("arm_joint", 2.687), ClearanceCut("boom_joint", -1.137))


def test_just_above_the_ground_the_boom_rises_before_the_bucket_opens() -> None:
    for name in ("zx200", "zx120"):
        arm, ways = Backhoe(MODELS[name]), Ways(MODELS[name], load("backhoe"))
        goal = Dig(TipGoal(0.1, -4.5, 0.0, 1.4), depth=0.4, drag=0.5, lift=0.2)
        now = ArmAngles(*excavate(arm, NOW, goal).targets[-1])
        plan = ways.plan(now, release(arm, now, Emptying(-0.34)), Scene())
        assert min(arm.bucket.lowest(pose) for pose in poses(plan)) > 0.1
        assert poses(plan)[-1].bucket == pytest.approx(-0.34)


OVER_TRUCK = TipGoal(0.0, 6.0, 4.2, 3.0)


def truck(x: float = 0.0, y: float = 6.0) -> Scene:
    """An ic120 lengthwise, the middle of its vessel at (x, y), where the bucket is emptied from its side."""
    model = MODELS["ic120"]
    posture = Posture(dict.fromkeys(model.joints, 0.0), 0.0)
    return Scene(tuple(Neighbour("ic120", model).obstacles(placed(x + 1.44, y, 0.0), 0.0, posture)))


def loaded() -> ArmAngles:
    return ArmAngles(*dug().made.samples[-1].positions[:4])


def test_while_it_swings_to_the_truck_the_bucket_is_level() -> None:
    near = TipGoal(0.0, 4.8, 4.8, 3.0)  # the boom rises so high that the bucket would open by 0.7 rad
    for scene, place in ((Scene(), OVER_TRUCK), (truck(), OVER_TRUCK), (truck(0.0, 4.8), near)):
        now = loaded()
        plan = WAYS.plan(now, release(BACKHOE, now, Emptying(-0.34, place)), scene)
        end = poses(plan)[-1]
        tilts = [abs(tilt(pose)) for pose in poses(plan) if abs(pose.swing - end.swing) > 0.1]
        assert len(tilts) > 20 and max(tilts) < TILT
        assert plan.made.samples[-1].positions[3] == pytest.approx(-0.34)


def test_a_place_over_which_the_bucket_would_spill_takes_the_nearest_angle_that_holds() -> None:
    now = loaded()
    moves = release(BACKHOE, now, Emptying(-0.34, TipGoal(0.0, 6.0, 4.0, 1.6)))
    assert moves.notes[0] == OtherAngle(LEVEL - TILT, 1.6) and abs(tilt(ArmAngles(*moves.targets[0]))) <= TILT + 1e-9


def test_the_boom_rises_while_the_upper_body_turns() -> None:
    now = loaded()
    plan = WAYS.plan(now, release(BACKHOE, now, Emptying(-0.34, OVER_TRUCK)), truck())
    both = [s for s in plan.made.samples if s.velocities[0] > 0.1 and s.velocities[1] < -0.05]
    assert len(both) > 10


@pytest.mark.parametrize("name", ["zx200", "zx120"])
def test_the_body_of_the_bucket_holds_a_heap_too(name: str) -> None:
    """Heaped 1:1 above the line from the pin to the teeth, across the bucket: half its width high in its middle."""
    model = MODELS[name]
    shape, tip = model.shapes["bucket_link"], model.geometry["bucket_end_joint"].xyz
    length = math.hypot(tip[0], tip[2])
    high = min((shape.max[1] - shape.min[1]) / 2, length / 2)
    for side in (1.0, -1.0) if name == "zx120" else (1.0,):
        x = tip[0] / 2 + side * high * tip[2] / length
        z = tip[2] / 2 - side * high * tip[0] / length
        assert shape.min[0] - 0.1 <= x <= shape.max[0] + 0.1 and shape.min[2] - 0.1 <= z <= shape.max[2] + 0.1


# a loaded bucket


def swings(arm: Backhoe, now: ArmAngles, **angles: float) -> Moves:
    goal = ChangePose(joints=({f"{name}_joint": angle for name, angle in angles.items()},))
    return arm.carrying(now, arm.change_pose(now, goal))


def test_soil_is_known_from_the_dig_until_the_bucket_was_open() -> None:
    arm, now = Backhoe(MODEL), loaded()
    turn = ChangePose(joints=({"swing_joint": 1.2},))
    assert swings(arm, now, swing=1.2, bucket=-0.3).through is None
    arm.begins(NOW, excavate(arm, NOW, FACE))
    held = swings(arm, now, swing=1.2, bucket=-0.3)
    assert held.through is not None and held.through.held is not None
    level, end = map(ArmAngles._make, held.targets)
    assert level.swing == end.swing == 1.2 and tilt(level) == pytest.approx(0.0) and end.bucket == -0.3
    assert swings(arm, now, bucket=-0.3).through is None  # it does not swing: it is emptied
    opened = now._replace(bucket=-0.3)
    assert swings(arm, opened, swing=1.2).through is None  # a check from where it would be open changes nothing
    assert swings(arm, now, swing=1.2).through is not None
    arm.begins(opened, arm.change_pose(opened, turn))
    assert swings(arm, now, swing=1.2, bucket=-0.3).through is None  # emptied in between


def test_a_loaded_bucket_opens_after_the_swing() -> None:
    arm, now = Backhoe(MODEL), loaded()
    arm.begins(NOW, excavate(arm, NOW, FACE))
    for scene in (Scene(), truck()):
        plan = WAYS.plan(now, swings(arm, now, swing=2.6, bucket=-0.3), scene)
        open_at = next(i for i, pose in enumerate(poses(plan)) if tilt(pose) > TILT)
        assert poses(plan)[open_at].swing == pytest.approx(2.6, abs=0.3)
        assert poses(plan)[-1].bucket == pytest.approx(-0.3)


# a cycle


def test_a_cycle_of_digging_and_loading_takes_less_than_40_s() -> None:
    """From over the truck: back, dig, and over the truck again, empty. Each goal ends with the lag of the machine."""
    scene, start = truck(), loaded()
    over = WAYS.plan(start, release(BACKHOE, start, Emptying(-0.34, OVER_TRUCK)), scene)
    emptied = ArmAngles(*over.made.samples[-1].positions[:4])
    back = dug(now=emptied, scene=scene)
    now = ArmAngles(*back.made.samples[-1].positions[:4])
    there = WAYS.plan(now, release(BACKHOE, now, Emptying(-0.34, OVER_TRUCK)), scene)
    seconds = back.made.duration + there.made.duration + 2 * WAYS.late
    assert 20.0 < seconds < 40.0
    for a, b in pairwise((back.made.samples[0], *back.made.samples)):
        assert b.time >= a.time
